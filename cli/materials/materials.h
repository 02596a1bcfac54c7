/* materials.h: the verbs of `abbe materials`, a file each.
 *
 * A verb is one line of ABBE_MATERIALS_VERBS and one function in cli/materials/materials_NAME.c.
 * The program finds it by its name, lists it with its summary in `abbe materials --help`, and hands
 * it its arguments with argv[0] "abbe materials NAME". No verb holds logic that a library could
 * use.
 */
#ifndef ABBE_CLI_MATERIALS_MATERIALS_H
#define ABBE_CLI_MATERIALS_MATERIALS_H

/* X(name, summary): every verb NAME is `int abbe_materials_NAME(int argc, char **argv)`. */
#define ABBE_MATERIALS_VERBS(X)                                                                    \
  X(list, "the materials of a table")                                                              \
  X(show, "one material: model, indices, Abbe number, absorption, source, fits")                   \
  X(plot, "draw the index over wavelength, with fits and measurements, or the glass map")          \
  X(nearest, "the materials nearest to an n_d and V_d, to a curve, or to points")                  \
  X(check, "what is wrong or doubtful in a table, and how to fix it")                              \
  X(fit, "a Cauchy or Sellmeier form through a material, a formula or points")                     \
  X(from, "a record from n_d and V_d, a gem's dispersion, A and B, or glTF's pair")                \
  X(diff, "what differs between two tables, and by how much")                                      \
  X(edit, "edit a record on the full screen, with live curves and warnings")                       \
  X(set, "change values of a record, and nothing else in the file")                                \
  X(add, "add a record to a table, new or from another table")                                     \
  X(remove, "take records out of a table")                                                         \
  X(rename, "give a record another name")                                                          \
  X(import, "make a table of catalogues, refractiveindex.info files and points")                   \
  X(export, "write materials as AGF, RII, CSV, YAML, or for other renderers")

#define ABBE_MATERIALS_DECLARE(name, summary) int abbe_materials_##name(int argc, char **argv);
ABBE_MATERIALS_VERBS(ABBE_MATERIALS_DECLARE)
#undef ABBE_MATERIALS_DECLARE

#endif
