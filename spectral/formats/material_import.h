/* material_import.h: materials from files of any kind that is read, into one table.
 *
 * Finds out what a file is and reads it. What could not be used is noted and does not stop the
 * rest.
 */
#ifndef ABBE_SPECTRAL_FORMATS_MATERIAL_IMPORT_H
#define ABBE_SPECTRAL_FORMATS_MATERIAL_IMPORT_H

#include "base/error.h"
#include "base/report.h"
#include "spectral/dispersion/csv_points.h"
#include "spectral/materials/material.h"
#include "spectral/materials/material_table.h"

#include <stddef.h>

typedef enum abbe_import_format {
  ABBE_IMPORT_AUTO,  /* what the file's own text says */
  ABBE_IMPORT_AGF,   /* a Zemax glass catalogue */
  ABBE_IMPORT_RII,   /* a file of refractiveindex.info */
  ABBE_IMPORT_CSV,   /* measured points: wavelength, n, and k or uncertainty */
  ABBE_IMPORT_YAML,  /* a table of ours */
  ABBE_IMPORT_STORE, /* a store of ours, SQLite */
  ABBE_IMPORT_MTLX,  /* a MaterialX document */
  ABBE_IMPORT_FORMAT_COUNT
} abbe_import_format;

/* Zero: found out, named after the file. */
typedef struct abbe_import_options {
  abbe_import_format format;
  const char *name; /* name of the one material that a file of RII or CSV holds; NULL: the file's */
  const char *source; /* source of measured points; NULL: "measured points in FILE" */
  abbe_csv_options csv;
} abbe_import_options;

/* What the bytes are: STORE where they begin as SQLite's; AGF where a line begins with NM, RII with
 * DATA:, YAML with materials:, MTLX with
 * <materialx. The first such line decides, one at the margin before one that is
 * indented, as remarks are. Else CSV where a line begins with two numbers, else AUTO. */
abbe_import_format abbe_import_detect(const char *text, size_t size);

/* Adds the materials of size bytes to the table, which may be zeroed; path stands for the file.
 * Points become a tabulated material, monotone between them. Names that stand there already are not
 * looked for: see abbe_material_table_unique. On failure the table is as it was. */
abbe_result abbe_import_parse(const char *bytes, size_t size, const char *path,
                              const abbe_import_options *options, abbe_material_table *into,
                              abbe_report *report, abbe_error *error);
/* The same from a file of at most 64 MiB; a store is read from a file alone, of any size. */
abbe_result abbe_import_load(const char *path, const abbe_import_options *options,
                             abbe_material_table *into, abbe_report *report, abbe_error *error);

/* After a table could not be read with `result`: where the file at path is a catalogue, a file of
 * refractiveindex.info or a list of points, error explains that and how it becomes a table; else it
 * stays as it is. Returns result. */
abbe_result abbe_import_explain(const char *path, abbe_result result, abbe_error *error);

/* Zemax glass catalogues (AGF files) as material tables.
 *
 * Reads what real catalogues hold: any encoding, either line end, free text before the first
 * glass, coefficient lines that wrap, missing fields and '-', an n_d of 1 that stands for none. A
 * glass that cannot be used is noted with its line, its name and the reason, and does not stop the
 * rest. Writing is in spectral/formats/material_write.h. */

/* The glasses of size bytes of catalogue in its order, each fit for a table (abbe_material_check);
 * name stands for the file in messages and sources. Indices are relative to air at the catalogue's
 * reference temperature (that of TD), the range is that of LD, internal transmittances (IT) become
 * attenuation, n_d and V_d of NM are kept as published; a GC line that begins with "source:" is the
 * source. ABBE_PARSE where there is no NM line, ABBE_SCHEMA where no glass could be used. */
abbe_result abbe_agf_parse(const char *bytes, size_t size, const char *name,
                           abbe_material_table *out, abbe_report *report, abbe_error *error);

/* Materials from files of the refractiveindex.info database.
 *
 * A file holds one material: an index (formula 1 to 9, tabulated n or nk), maybe k, where the
 * numbers come from, and what a maker's catalogue says. It does not read the database's catalogue
 * of pages, the nonlinear index, or formulas for k. Writing is in
 * spectral/formats/material_write.h. */

/* The material of size bytes of text [RefractiveIndexInfo], fit for a table. path stands for the
 * file in messages; name is the material's name, or NULL to make one of the path:
 * …/main/SiO2/nk/Malitson.yml is SiO2-Malitson, …/optical/N-BK7.yml is N-BK7. k becomes
 * attenuation, or the index a conductor's (spectral/materials/absorption.h), with a note;
 * references and comments lose their HTML. Indices or wavelengths that the file calls absolute (of
 * the vacuum) are kept and get a warning. *out is freed by the caller where the result is ABBE_OK.
 * ABBE_SCHEMA or ABBE_PARSE, with file and line, where there is no usable index. */
abbe_result abbe_rii_parse(const char *text, size_t size, const char *path, const char *name,
                           abbe_material *out, abbe_report *report, abbe_error *error);

/* The transmitting shaders of a MaterialX document: open_pbr_surface, standard_surface and
 * gltf_pbr.
 *
 * Each becomes Cauchy's two terms through its index and Abbe number, and its colour at a distance
 * an attenuation [OpenPBR]. SR_ before a name is dropped. A shader that does not transmit, or takes
 * its numbers from other nodes, is noted as SKIPPED. ABBE_PARSE, with the line, for what is no XML
 * and for a number that is none, ABBE_SCHEMA where there is no such shader. */
abbe_result abbe_mtlx_parse(const char *text, size_t size, const char *path,
                            abbe_material_table *out, abbe_report *report, abbe_error *error);

/* Materials from many files and whole folders: those of one name are kept apart by the files that
 * they come from. A file that cannot be used is noted and does not stop the rest. */

typedef struct abbe_import_batch {
  const char *const *path; /* [count] files and folders */
  size_t count;
  const char *prefix; /* stands before every name; NULL: none */
  const char
      *target; /* what the table is to be written to, so none of the files; NULL: not known */
  abbe_import_options import;
  struct abbe_material_store_maker *store; /* takes each file's materials; NULL: they stay here */
} abbe_import_batch;

/* Adds what the files hold to the table, which may be zeroed; report may be NULL. From a folder
 * come, in the order of their names and with the folders in it, those files that end in .agf, .yml,
 * .yaml, .csv, .sqlite or .mtlx and hold materials; hidden ones and links to folders do not.
 *
 * Where several files have a material of one name, each is called FOLDER-NAME or FILE-NAME, after
 * the part of its path by which they differ, with a note of kind RENAMED; where nothing differs,
 * the first stays. One of several files that cannot be read is a note of kind SKIPPED.
 *
 * ABBE_INVALID_ARGUMENT for no path, for import.name with several files, and where the target is
 * one of them; ABBE_IO where a path is neither a file nor a folder: before anything is read. The
 * first file's own failure where no file could be used; ABBE_NO_MEMORY. */
abbe_result abbe_import_batch_run(const abbe_import_batch *batch, abbe_material_table *into,
                                  abbe_report *report, abbe_error *error);

/* Tells materials of one name apart and puts the prefix before all names; the first of those that
 * are still alike stays. origin[origins]: the files that the table's first materials come from. */
abbe_result abbe_import_name_all(const abbe_import_batch *batch, abbe_material_table *table,
                                 const char *const *origin, size_t origins, abbe_report *report,
                                 abbe_error *error);

/* A table of materials from where it is: compiled in, a file of YAML, or a
 * store of many.
 *
 * A store is an SQLite file (spectral/store/material_store.h). A catalogue is no table: the error
 * says how it becomes one (spectral/formats/material_import.h). */

/* Loads a table: NULL or "default", "thesis", or the path of a YAML file (at most 16 MiB) or of a
 * store. */
abbe_result abbe_material_table_load(const char *path, abbe_material_table *out, abbe_error *error);
/* The same for a caller that needs these names alone: from a store no other rows are read. Names
 * that it does not have are no failure here; abbe_material_table_find reports each. */
abbe_result abbe_material_table_load_named(const char *path, const char *const *names, size_t count,
                                           abbe_material_table *out, abbe_error *error);
/* A table to be examined, not used, as abbe_material_table_parse_lenient has it. */
abbe_result abbe_material_table_load_lenient(const char *path, abbe_material_table *out,
                                             abbe_report *report, abbe_error *error);

#endif
