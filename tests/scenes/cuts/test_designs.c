/* The designs that ship: each is closed, with the corners, edges and faces that it was drawn with,
 * no facet that cuts nothing, and the symmetry that it says. */
#include "scenes/cuts/cut_file.h"
#include "scenes/cuts/cut_polyhedron.h"
#include "scenes/cuts/cut_stretch.h"

#include "tests/check.h"

#include <dirent.h>

static const struct {
  const char *name;
  size_t corners, edges, faces, girdle;
} designs[] = {
    {"barion", 57, 92, 37, 4},
    {"brilliant-diamond", 57, 128, 73, 16},
    {"brilliant-quartz", 57, 128, 73, 16},
    {"briolette", 146, 228, 84, 0},
    {"cushion", 57, 128, 73, 16},
    {"emerald", 62, 117, 57, 8},
    {"marquise", 57, 128, 73, 16},
    {"oval", 57, 128, 73, 16},
    {"pear", 57, 128, 73, 16},
    {"portuguese", 241, 384, 145, 16},
    {"princess", 37, 80, 45, 4},
    {"rose", 67, 108, 43, 12},
    {"step-square", 21, 40, 21, 4},
};
enum { COUNT = sizeof designs / sizeof *designs };

static void read(size_t i, abbe_cut *cut, abbe_cut_polyhedron *p) {
  abbe_error why = {0};
  OK(abbe_cut_file_read(printed(ABBE_SOURCE_DIR "/scenes/designs/%s.asc", designs[i].name), cut,
                        NULL, &error));
  if (abbe_cut_polyhedron_make(cut, 0, p, &why) != ABBE_OK)
    fail_msg("%s: %s", designs[i].name, why.text);
}

TEST(each_is_closed) {
  for (size_t i = 0; i < COUNT; i++) {
    OWNED(abbe_cut_polyhedron, p);
    abbe_cut_measures m;
    FILLED(abbe_cut, cut, read(i, &cut, &p));
    abbe_cut_measures_make(&cut, &p, &m);
    if (p.vertex_count != designs[i].corners || p.edge_count != designs[i].edges ||
        p.face_count != designs[i].faces || m.faces[ABBE_CUT_GIRDLE] != designs[i].girdle ||
        m.dead + m.doubled != 0)
      fail_msg("%s: %zu corners, %zu edges, %zu faces, %zu of the girdle, %zu dead",
               designs[i].name, p.vertex_count, p.edge_count, p.face_count,
               m.faces[ABBE_CUT_GIRDLE], m.dead + m.doubled);
    assert_int_equal(p.vertex_count + p.face_count, p.edge_count + 2);
    assert_true(cut.heading[0] != NULL && cut.refractive_index > 1.3 && m.width > 0.5);
  }
}

/* Whether a plane lies where another is turned to, or mirrored and turned. */
static bool has_plane(const abbe_cut *cut, const double n[3], double d) {
  const double near = 1e-6;
  for (size_t i = 0; i < cut->facet_count; i++) {
    const abbe_cut_facet *f = &cut->facet[i];
    if (fabs(f->n[0] - n[0]) < near && fabs(f->n[1] - n[1]) < near && fabs(f->n[2] - n[2]) < near &&
        fabs(f->d - d) < near)
      return true;
  }
  return false;
}

TEST(each_has_its_symmetry) {
  for (size_t i = 0; i < COUNT; i++) {
    OWNED(abbe_cut_polyhedron, p);
    FILLED(abbe_cut, cut, read(i, &cut, &p));
    const double turn = 2 * 3.14159265358979323846 / cut.folds;
    assert_true(cut.folds >= 1);
    for (size_t f = 0; f < cut.facet_count; f++) {
      const double *n = cut.facet[f].n, d = cut.facet[f].d;
      const double turned[] = {n[0] * cos(turn) + n[1] * sin(turn),
                               n[1] * cos(turn) - n[0] * sin(turn), n[2]};
      const double mirrored[] = {-n[0], n[1], n[2]};
      if (!has_plane(&cut, turned, d) || (cut.mirror && !has_plane(&cut, mirrored, d)))
        fail_msg("%s: facet %zu has no like", designs[i].name, f + 1);
    }
  }
}

TEST(none_is_forgotten) {
  size_t files = 0;
  DIR *folder = opendir(ABBE_SOURCE_DIR "/scenes/designs");
  assert_non_null(folder);
  for (const struct dirent *entry; (entry = readdir(folder)) != NULL;)
    files += strstr(entry->d_name, ".asc") != NULL;
  closedir(folder);
  assert_int_equal(files, COUNT);
}
