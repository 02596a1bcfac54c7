#include "cli/base/arguments.h"
#include "cli/base/command.h"
#include "cli/base/progress.h"
#include "cli/options/picture_options.h"
#include "cli/options/scene_input.h"

#include "base/text.h"
#include "scenes/volume/caustic_volume.h"
#include "validation/lab/volume_fill.h"

#include <cjson/cJSON.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

typedef struct request {
  const char *program, *scene, *out, *object, *light, *materials;
  abbe_scene_input_changes changes;
  abbe_volume_fill_desc desc;
  abbe_work_options work;
  double radii; /* radii of the region, in the object's; 0: 3 */
  bool json, quiet;
} request;

enum { OPTION_SHELLS = 0x100, OPTION_GRID, OPTION_PRINTED };

static const abbe_option options[] = {
    {"output", 'o', "FILE.exr", ABBE_ARGUMENT_WRITES, "the volume", 0,
     ABBE_TAKE_TARGET(request, out, ".exr")},
    {"json", 0, NULL, 0, "what was done, as JSON on standard output", 0,
     ABBE_TAKE_FLAG(request, json)},
    {"quiet", 'q', NULL, 0, "no progress, no summary", 0, ABBE_TAKE_FLAG(request, quiet)},
    {"object", 0, "NAME", 0, "whose caustics; the scene's only refractor without", 1,
     ABBE_TAKE_TEXT(request, object)},
    {"light", 0, "NAME", 0, "of whose colour the light is; the first without", 1,
     ABBE_TAKE_TEXT(request, light)},
    {"nodes", 0, "N", 0, "directions of light: 1, 12, 42, 162, 642 or 2562 (162; of a ball 1)", 1,
     ABBE_TAKE_COUNT(request, desc.nodes, 1, ABBE_LIGHT_NODES_MOST)},
    {"rays", 0, "N", 0,
     "the rays of N points of the object's surface in place of cells' values: any illuminant, "
     "lamps "
     "nearby, sharp between nodes",
     1, ABBE_TAKE_COUNT(request, desc.exits, 1, ABBE_LIGHT_EXITS_MOST)},
    {"asymmetric", 0, NULL, 0,
     "of rays: do not look for the object's symmetry, to measure what it saves", 1,
     ABBE_TAKE_FLAG(request, desc.asymmetric)},
    {"shells", OPTION_SHELLS, "SxN|SxMxM", 0,
     "S shells of N triangles (80, 320, 1280, 5120 ...) or M x M octahedral texels (24x5120; of "
     "rays 24x48x48)",
     1, ABBE_TAKE_BY_KEY},
    {"grid", OPTION_GRID, "N", 0, "or N x N x N cubes, 2 to 256", 1, ABBE_TAKE_BY_KEY},
    {"radii", 0, "X", 0, "how far the region goes, in radii of the object (3)", 1,
     ABBE_TAKE_NUMBER(request, radii, 1.1, 1000)},
    {"printed", OPTION_PRINTED, NULL, 0, "bytes as the method was published, for wyman2003", 1,
     ABBE_TAKE_BY_KEY},
    {"photons", 0, "N", 0, "of a node and pass (262144)", 2,
     ABBE_TAKE_COUNT(request, desc.photons, 1, ABBE_VOLUME_FILL_MOST_PHOTONS)},
    {"passes", 0, "N", 0, "of a node (4)", 2,
     ABBE_TAKE_COUNT(request, desc.passes, 1, ABBE_VOLUME_FILL_MOST_PASSES)},
    {"until-error", 0, "X", 0, "more passes, until a node's relative standard error is below X", 2,
     ABBE_TAKE_NUMBER(request, desc.until_error, 1e-6, 1)},
    ABBE_WORK_OPTIONS(request, work, 2, 2),
    {"checkpoint", 0, "FILE", ABBE_ARGUMENT_WRITES,
     "where it is kept until all is done (OUTPUT.checkpoint)", 2,
     ABBE_TAKE_TEXT(request, desc.checkpoint)},
    {"materials", 0, "TABLE", ABBE_ARGUMENT_READS,
     "a table instead of the scene's: default, thesis or a file", 1,
     ABBE_TAKE_TEXT(request, materials)},
    ABBE_OPTIONS(request, &abbe_scene_input_options, changes, NULL, 0),
    ABBE_NEEDED(request, scene, "of which scene? Try scenes/sphere.yaml"),
    ABBE_NEEDED(request, out, "where to? Give -o FILE.exr"),
    {0}};

/* "24x5120" or "24x72x72". */
static void take_shells(request *q, const char *text) {
  abbe_region_desc *r = &q->desc.region;
  unsigned long n[3] = {0};
  int count = 0;
  for (const char *at = text; count < 3; count++) {
    char *end;
    n[count] = *at >= '0' && *at <= '9' ? strtoul(at, &end, 10) : 0;
    if (n[count] == 0) break;
    at = end + (*end == 'x');
    if (*end != 'x' && *end != '\0') break;
    if (*end == '\0') {
      count++;
      break;
    }
  }
  *r = (abbe_region_desc){.shells = n[0]};
  size_t faces = 20;
  for (; count == 2 && faces < n[1] && r->levels < ABBE_SPHERE_MESH_MOST_LEVELS; faces *= 4)
    r->levels++;
  if (count == 2 && faces == n[1] && n[1] > 20) {
    r->kind = ABBE_REGION_GEODESIC;
  } else if (count == 3 && n[1] == n[2]) {
    r->kind = ABBE_REGION_OCTAHEDRAL;
    r->side = n[1];
  } else {
    fprintf(stderr,
            "%s: --shells '%s': shells and their cells, such as 24x5120 (80, 320, 1280, 5120, "
            "20480 or 81920 triangles) or 24x72x72 (texels)\n",
            q->program, text);
    exit(ABBE_EXIT_USAGE);
  }
}

static error_t parse(int key, char *text, struct argp_state *state) {
  request *q = state->input;
  abbe_volume_fill_desc *d = &q->desc;
  switch (key) {
  case OPTION_SHELLS:
    take_shells(q, text);
    return 0;
  case OPTION_GRID:
    d->region = (abbe_region_desc){
        .kind = ABBE_REGION_GRID,
        .side = abbe_command_count(q->program, "--grid", text, 2, ABBE_REGION_MOST_SIDE)};
    return 0;
  case OPTION_PRINTED:
    d->kind = ABBE_VOLUME_PRINTED;
    return 0;
  case ARGP_KEY_ARG:
    if (q->scene != NULL) argp_error(state, "one scene at a time: what is '%s'?", text);
    q->scene = text;
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

static abbe_result find_object(const request *q, const abbe_scene *scene, size_t *out,
                               abbe_error *error) {
  const char *names[ABBE_SCENE_MAX_OBJECTS];
  size_t count = 0;
  for (size_t i = 0; i < scene->object_count; i++) {
    if (abbe_object_kind_of(&scene->object[i]) == ABBE_OBJECT_RECEIVER || scene->object[i].cloud)
      continue;
    names[count++] = scene->object[i].name;
    if (q->object == NULL || strcmp(q->object, scene->object[i].name) == 0) *out = i;
    if (q->object != NULL && *out == i) return ABBE_OK;
  }
  if (q->object == NULL && count == 1) return ABBE_OK;
  if (q->object == NULL)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: %zu objects bend light; say of which: --object NAME", q->scene,
                          count);
  const char *near = abbe_nearest_word(q->object, names, (int)count);
  return abbe_error_set(error, ABBE_NOT_FOUND, "%s: no object '%s' bends light%s%s%s", q->scene,
                        q->object, near ? "; did you mean '" : "", near ? near : "",
                        near ? "'?" : "");
}

static abbe_result fill(request *q, const abbe_scene *scene, abbe_caustic_volume *volume,
                        abbe_volume_fill_statistics *done, abbe_error *error) {
  abbe_progress progress;
  abbe_volume_body body;
  q->desc.object = (size_t)-1;
  abbe_result result = find_object(q, scene, &q->desc.object, error);
  if (result == ABBE_OK && q->light != NULL)
    result = abbe_scene_find_light(scene, q->light, &q->desc.light, error);
  if (result == ABBE_OK && q->radii > 0) {
    result = abbe_volume_body_make(&scene->object[q->desc.object], &body, error);
    q->desc.region.outer = q->radii * body.radius;
  }
  if (result != ABBE_OK) return result;
  q->desc.min_nm = q->work.min_nm;
  q->desc.max_nm = q->work.max_nm;
  q->desc.seed = q->work.seed;
  q->desc.threads = q->work.threads;
  q->desc.resume = q->work.resume;
  q->desc.checkpoint_s = q->work.every_s;
  q->desc.progress = abbe_progress_update;
  q->desc.user = &progress;
  q->desc.stop = abbe_progress_stopped();
  abbe_progress_begin(&progress, "volume", q->quiet);
  result = abbe_volume_fill(scene, &q->desc, volume, done, error);
  abbe_progress_end(&progress);
  return result;
}

static double file_bytes(const char *path) {
  struct stat s;
  return stat(path, &s) == 0 ? (double)s.st_size : 0;
}

static void summarise(const request *q, const abbe_caustic_volume *v,
                      const abbe_volume_fill_statistics *s) {
  const double nodes = (double)v->nodes.count;
  fprintf(stderr,
          "%s: %zu node%s of %zu cells; %.3g photons and %.3g s a node; %.4g MB in memory, %.4g on "
          "disk\n",
          v->body.name, v->nodes.count, v->nodes.count > 1 ? "s" : "", v->region.cells,
          (double)s->photons / nodes, s->seconds / nodes,
          1e-6 * (double)abbe_caustic_volume_bytes(v), 1e-6 * file_bytes(q->out));
  if (v->kind == ABBE_VOLUME_EXITS)
    fprintf(
        stderr,
        "%zu exits of %zu points, and of %zu maps of them, carry %.4g of the light; %zu sequences "
        "of facets; of %.2g it is not known how they change\n",
        v->exits.count, v->exits.points, s->maps, s->carried, s->sequences, s->alone);
  if (s->error > 0) fprintf(stderr, "relative standard error %.2g\n", s->error);
  if (s->outflow[1] > 0)
    fprintf(stderr, "flux out through the shells: %.5g to %.5g of what left the object\n",
            s->outflow[0], s->outflow[1]);
}

static abbe_result print_json(const request *q, const abbe_caustic_volume *v,
                              const abbe_volume_fill_statistics *s, abbe_error *error) {
  cJSON *root = cJSON_CreateObject();
  const struct {
    const char *name;
    double value;
  } all[] = {
      {"nodes", (double)v->nodes.count},   {"cells", (double)v->region.cells},
      {"radius_m", v->body.radius},        {"photons", (double)s->photons},
      {"passes", (double)s->passes},       {"seconds", s->seconds},
      {"relative_error", s->error},        {"bytes_memory", (double)abbe_caustic_volume_bytes(v)},
      {"bytes_disk", file_bytes(q->out)},  {"reached_w", s->ledger.reached},
      {"missed_w", s->ledger.missed},      {"exits", (double)v->exits.count},
      {"exits_carried", s->carried},       {"exits_alone", s->alone},
      {"sequences", (double)s->sequences}, {"points", (double)v->exits.points},
      {"symmetry", (double)s->maps},       {"absorbed_w", s->ledger.absorbed},
      {"lost_w", s->ledger.lost},          {"outflow_least", s->outflow[0]},
      {"outflow_greatest", s->outflow[1]}};
  bool made = cJSON_AddStringToObject(root, "file", q->out) != NULL &&
              cJSON_AddStringToObject(root, "object", v->body.name) != NULL;
  for (size_t i = 0; i < sizeof all / sizeof *all; i++)
    made = made && cJSON_AddNumberToObject(root, all[i].name, all[i].value) != NULL;
  return abbe_command_print_json(root, made, error);
}

/* Beside the volume, where it has no name of its own. */
static abbe_result name_checkpoint(request *q, char **path, abbe_error *error) {
  const size_t size = strlen(q->out) + 16;
  *path = malloc(size);
  if (*path == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory");
  snprintf(*path, size, "%s.checkpoint", q->out);
  if (q->desc.checkpoint == NULL) {
    q->desc.checkpoint = *path;
    abbe_arguments_add(q->program, ABBE_ARGUMENT_WRITES, "the checkpoint", *path);
  }
  return ABBE_OK;
}

static abbe_result run(request *q, const abbe_scene *scene, abbe_error *error) {
  ABBE_OWNED(abbe_caustic_volume, volume) = {0};
  abbe_volume_fill_statistics done;
  ABBE_FREED char *path = NULL;
  ABBE_TRY(name_checkpoint(q, &path, error));
  ABBE_TRY(fill(q, scene, &volume, &done, error));
  ABBE_TRY(abbe_volume_file_write(q->out, &volume, error));
  remove(q->desc.checkpoint);
  if (!q->quiet) summarise(q, &volume, &done);
  if (q->json) ABBE_TRY(print_json(q, &volume, &done, error));
  return ABBE_OK;
}

int abbe_command_volume(int argc, char **argv) {
  static const abbe_parser parser = {
      .options = options,
      .parse = parse,
      .args_doc = "SCENE.yaml",
      .doc =
          "Computes an object's caustics beforehand: the light that it sends to the space around "
          "it, for light from many directions. 'abbe render --transport volume' then looks them "
          "up, wherever the object and the light are moved to.\v"
          "Examples:\n"
          "  abbe volume scenes/sphere.yaml -o sphere-volume.exr\n"
          "  abbe volume scenes/prism.yaml -o prism-volume.exr --nodes 642 --shells 24x48x48\n"
          "  abbe volume scenes/ring.yaml -o ring-volume.exr --grid 64 --until-error 0.02\n"
          "  abbe volume scenes/ring.yaml -o ring-volume.exr --grid 64 --until-error 0.02 "
          "--resume\n"
          "  abbe volume scenes/prism.yaml -o prism-rays.exr --rays 16384 --shells 32x64x64\n"
          "  abbe volume scenes/sphere.yaml -o printed.exr --nodes 162 --printed\n"
          "  abbe render scenes/sphere.yaml --png sphere.png --transport volume --volume "
          "sphere-volume.exr\n",
  };
  request q = {.program = argv[0], .work.every_s = 30};
  abbe_arguments_parse(&parser, ABBE_ARGUMENT_READS, argc, argv, &q);
  abbe_error error = {0};
  abbe_scene scene = {0};
  abbe_result result = abbe_command_check_targets((const char *const[]){q.out}, 1, &error);
  if (result == ABBE_OK)
    result = abbe_scene_input_load_with(argv[0], q.scene, q.materials, &q.changes, &scene, &error);
  if (result == ABBE_OK) result = run(&q, &scene, &error);
  abbe_scene_free(&scene);
  return abbe_command_end(q.program, result, &error);
}
