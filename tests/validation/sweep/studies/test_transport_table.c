/* Tables of ways for light: the columns of each row, the best of each kind at equal bytes, slopes.
 */
#include "tests/check.h"

#include "base/file.h"
#include "validation/sweep/studies/transport_table.h"

#include <unistd.h>

static abbe_transport_study s;

static abbe_transport_contestant *add(double bytes, double de) {
  abbe_transport_row *row = &s.row[s.count++];
  *row = (abbe_transport_row){.contestant = {.fill = {.passes = 1}}};
  for (int k = 0; k < ABBE_TRANSPORT_NUMBER_COUNT; k++) row->number[k] = NAN;
  row->contestant.render.transport = ABBE_TRANSPORT_VOLUME;
  row->number[ABBE_TRANSPORT_NODES_NUMBER] = 42;
  row->number[ABBE_TRANSPORT_BYTES_MEMORY_NUMBER] = bytes;
  row->number[ABBE_TRANSPORT_CAUSTIC_DE_NUMBER] = de;
  return &row->contestant;
}

static void make_study(void) {
  const abbe_region_desc grid = {.kind = ABBE_REGION_GRID, .side = 27},
                         texels = {.kind = ABBE_REGION_OCTAHEDRAL, .shells = 24, .side = 32};
  s = (abbe_transport_study){.scene = "prism.yaml"};
  add(900, 7)->fill.region = grid;
  add(1001, 2)->fill.region = texels; /* too large */
  add(800, 6)->fill.region = texels;
  add(1000, 5)->fill.region = texels;
  add(10, 4)->fill.exits = 100;
  abbe_transport_contestant *joined = add(500, 3);
  joined->fill.region = texels;
  joined->fill.joins = true;
  joined->fill.tolerance = 0.25;
  abbe_transport_contestant *printed = add(1000, 9);
  printed->fill.region = grid;
  printed->fill.kind = ABBE_VOLUME_PRINTED;
  printed->render.profile = ABBE_PROFILE_WYMAN2003;
  for (int i = 0; i < 2; i++) {
    abbe_transport_contestant *pinholes = add(NAN, 1);
    *pinholes = (abbe_transport_contestant){.render = {.transport = ABBE_TRANSPORT_PINHOLE,
                                                       .footprint = ABBE_FOOTPRINT_ON,
                                                       .pinholes = i == 0 ? 100 : 400}};
    s.row[s.count - 1].number[ABBE_TRANSPORT_SAMPLES_NUMBER] = i == 0 ? 100 : 400;
    s.row[s.count - 1].number[ABBE_TRANSPORT_LIMIT_RMSE_NUMBER] = i == 0 ? 0.4 : 0.1;
  }
}

TEST(for_people) {
  make_study();
  FREED char *text = NULL;
  size_t size;
  FILE *out = open_memstream(&text, &size);
  assert_non_null(out);
  abbe_transport_table_print(&s, out);
  fclose(out);
  const char *equal = strstr(text, "| at most 1e+03 bytes | bytes |");
  assert_non_null(equal);
  const char *rest = strstr(equal, "|---|");
  static const char rows[] =
      "|---|---|---|---|---|---|\n"
      "| volume, 42 nodes, grid 27 | 900 | 7 | - | - | - |\n"
      "| volume, 42 nodes, shells 24x32x32 | 1000 | 5 | - | - | - |\n"
      "| volume, 42 nodes, shells 24x32x32 joined 0.25 | 500 | 3 | - | - | - "
      "|\n"
      "| volume, 42 nodes, rays 100 | 10 | 4 | - | - | - |\n"
      "| wyman2003, 42 nodes, grid 27 | 1000 | 9 | - | - | - |\n"
      "pinhole, footprint on: slope -1.00\n";
  assert_string_equal(rest, rows);
}

TEST(for_programs) {
  char path[] = "/tmp/abbe-test-table-XXXXXX", *text;
  size_t size;
  const int file = mkstemp(path);
  assert_true(file >= 0);
  close(file);
  make_study();
  s.row[0].number[ABBE_TRANSPORT_NODE_ERROR_NUMBER] = 0.5;
  s.row[0].number[ABBE_TRANSPORT_MID_ERROR_NUMBER] = 0.75;
  s.row[0].on_bytes = true;
  OK(abbe_transport_table_save(&s, path, &error));
  OK(abbe_file_read(path, 1 << 16, &text, &size, &error));
  assert_contains(text, "# scene: prism.yaml\n"
                        "transport,footprint,region,lookup,samples,nodes,cells,"
                        "photons_node,precompute_s,bytes_memory,bytes_disk,bytes_gpu,frame_ms,"
                        "lookup_ms,none_ms,over_none,moved_ms,caustic_de,caustic_de_noise,"
                        "caustic_rmse,caustic_rmse_noise,node_error,mid_error,limit_rmse,pop,"
                        "flux_drift,pays_after,front_time,front_bytes\n");
  assert_contains(text, "\nvolume,,grid 27,auto,,42,,,,900,,,,,,,,7,,,,0.5,0.75,,,,,,yes\n");
  assert_contains(text, "\npinhole,on,,,100,");
  free(text);
  unlink(path);
}
