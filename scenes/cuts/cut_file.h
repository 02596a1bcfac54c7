/* cut_file.h: a file of a design, of whatever kind: GemCad's text (.asc) and binary (.gem), Gem Cut
 * Studio's (.gcs). */
#ifndef ABBE_SCENES_CUTS_CUT_FILE_H
#define ABBE_SCENES_CUTS_CUT_FILE_H

#include "base/error.h"
#include "base/report.h"
#include "scenes/cuts/cut.h"
#include "scenes/cuts/cut_polyhedron.h"
#include "spectral/materials/material.h"

#include <stdio.h>

#define ABBE_CUT_MAX_FILE (16u << 20) /* bytes */

/* By its name's end. report (may be NULL) gets what was left out, changed or assumed.
 * ABBE_UNSUPPORTED for another ending; ABBE_IO, and errors of the kind's own. */
abbe_result abbe_cut_file_read(const char *path, abbe_cut *out, abbe_report *report,
                               abbe_error *error);

/* The same with its stone, whose corners nearer than the share weld of half its width are one:
 * where the planes make none, the error names the file. Both outputs are to be freed. */
abbe_result abbe_cut_file_read_stone(const char *path, double weld, abbe_cut *cut,
                                     abbe_cut_polyhedron *stone, abbe_report *report,
                                     abbe_error *error);

/* GemCad's text files of designs (.asc), in and out.
 *
 * Files of other programs are met with a word out of place; it is left out and noted. Every index
 * is listed in such a file: its line of symmetry is for people. Lines may end in any way, and the
 * text be UTF-8 or Windows-1252. */

/* name is for messages; report (may be NULL) gets what was left out, changed or assumed.
 * ABBE_PARSE for what is no design, ABBE_SCHEMA for values that none has, with the line. */
abbe_result abbe_cut_asc_parse(const char *data, size_t size, const char *name, abbe_cut *out,
                               abbe_report *report, abbe_error *error);

/* Windows-1252, lines that end with a newline. What is read back has the same planes: numbers have
 * GemCad's digits, or all that they need. report (may be NULL) gets what the format does not hold.
 */
abbe_result abbe_cut_asc_write(const abbe_cut *cut, FILE *to, abbe_report *report,
                               abbe_error *error);

/* Gem Cut Studio's files of designs (.gcs), in and out.
 *
 * XML of tiers and facets. A facet's normal rules over its index; a tier's depth may be missing,
 * and then the facet's corners give it. Designs are turned by half a turn about z, so that the
 * index at the gear's offset is in the direction of y, and indices are worked out anew from the
 * normals: those of the program run in the other direction on the crown. Document types, entities
 * and whatever else could reach outside the file are refused. */

/* name is for messages; report (may be NULL) gets what was left out or assumed. ABBE_PARSE for what
 * is no such file, ABBE_SCHEMA for values that no stone has, with the line. */
abbe_result abbe_cut_gcs_parse(const char *data, size_t size, const char *name, abbe_cut *out,
                               abbe_report *report, abbe_error *error);

/* UTF-8, with the facets' corners; polyhedron is the cut's. As the program has it, the stone is
 * scaled so that its corners reach 1 in x or y, and its middle height is 0; facets without a face
 * are left out, and a tier whose facets lie at several distances has none of its own. report (may
 * be NULL) gets what was left out. ABBE_IO where the stream fails; ABBE_GEOMETRY where the middle
 * height lies outside a facet's plane, which the format cannot say. */
abbe_result abbe_cut_gcs_write(const abbe_cut *cut, const abbe_cut_polyhedron *polyhedron, FILE *to,
                               abbe_report *report, abbe_error *error);

/* GemCad's binary files of designs (.gem), in and out.
 *
 * A file holds each facet's plane and polygon. The planes rule: the polygons of some files are of
 * another size, and they are not read. Angles and indices are worked out from the planes. The
 * second design that a file may carry, the preform, is left out. */

/* name is for messages; report (may be NULL) gets what was left out. ABBE_PARSE for what is no such
 * file, ABBE_SCHEMA for values that no stone has, with the byte. */
abbe_result abbe_cut_gem_parse(const char *data, size_t size, const char *name, abbe_cut *out,
                               abbe_report *report, abbe_error *error);

/* With the polygons of the polyhedron, which is the cut's. report (may be NULL) gets what the
 * format does not hold: texts beyond 255 bytes. */
abbe_result abbe_cut_gem_write(const abbe_cut *cut, const abbe_cut_polyhedron *polyhedron, FILE *to,
                               abbe_report *report, abbe_error *error);

/* A design on a sheet, as cutters work from it.
 *
 * The crown from above, the pavilion from below, two profiles, the wheel of indices around both,
 * names on the facets, the proportions, and a table of the tiers. Drawn by cairo. Sheets are as
 * wide as A4 and as long as the table needs, A4 at the least. */

/* Pixels of a PNG per point (1/72 inch). */
#define ABBE_CUT_DIAGRAM_PIXELS 2

/* Draws the cut's polyhedron. The format is the name's ending: .pdf, .svg or .png. note, under the
 * proportions, may be NULL. Tiers of the pavilion below the critical angle of index n are marked,
 * 0: none. ABBE_INVALID_ARGUMENT for another ending, ABBE_IO, ABBE_NO_MEMORY. */
abbe_result abbe_cut_diagram_write(const char *path, const abbe_cut *cut,
                                   const abbe_cut_polyhedron *polyhedron, const char *note,
                                   double n, abbe_error *error);

/* The stone of a design as a solid for other programs: STL, OBJ, glTF.
 *
 * Facets stay flat: no corner is shared between two of them where a format has normals. Lengths are
 * metres in glTF, y up, and millimetres in STL and OBJ, z up. */

/* X(code, ending): .gltf is not written, for it is two files. */
#define ABBE_CUT_SOLIDS(X)                                                                         \
  X(STL, ".stl")                                                                                   \
  X(OBJ, ".obj")                                                                                   \
  X(GLB, ".glb")

typedef enum abbe_cut_solid_format {
#define ABBE_CUT_SOLID_ENUM(code, ending) ABBE_CUT_SOLID_##code,
  ABBE_CUT_SOLIDS(ABBE_CUT_SOLID_ENUM)
#undef ABBE_CUT_SOLID_ENUM
      ABBE_CUT_SOLID_COUNT
} abbe_cut_solid_format;

/* The format of a path's ending, or ABBE_CUT_SOLID_COUNT. */
abbe_cut_solid_format abbe_cut_solid_format_of(const char *path);

/* Writes the cut's polyhedron; scale is metres a unit of the design, above 0. STL is binary. OBJ
 * has a group a facet, of its name, and polygons. In glTF the stone has KHR_materials_ior,
 * transmission, volume and dispersion ([glTFDispersion]: 20 over
 * V_d), colours by the transmittance of the stone's own width; material NULL: an index of 1.5
 * without dispersion. ABBE_OUT_OF_RANGE where the material does not cover the visible,
 * ABBE_NO_MEMORY, ABBE_IO. */
abbe_result abbe_cut_solid_write(const abbe_cut *cut, const abbe_cut_polyhedron *polyhedron,
                                 double scale, const abbe_material *material,
                                 abbe_cut_solid_format format, FILE *to, abbe_error *error);

#endif
