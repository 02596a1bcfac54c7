/* Whatever names and texts of files and arguments hold, the program says text that a terminal may
 * show. */
#include "tests/cli/run_program.h"

#include "base/file.h"
#include "colorimetry/image/exr.h"

#include <cjson/cJSON.h>
#include <locale.h>
#include <wchar.h>
#include <wctype.h>

/* A title for the window, a colour, DEL, a C1 control both as UTF-8 and as a byte, half a letter.
 */
#define EVIL                                                                                       \
  "\x1b]0;x\x07\x1b[31m\x7f\xc2\x9b"                                                               \
  "1m\x9b"                                                                                         \
  "2m\xe2\x82"

/* As libc's own tables of letters and controls have it. */
static bool is_printable(const char *text) {
  mbstate_t state = {0};
  const size_t left = strlen(text);
  for (size_t i = 0, step; i < left; i += step) {
    wchar_t letter;
    step = mbrtowc(&letter, text + i, left - i, &state);
    if (step > 4) return false; /* no UTF-8 */
    if (iswcntrl((wint_t)letter) && letter != L'\n' && letter != L'\t') return false;
  }
  return true;
}

static void path_of(const char *name, char path[300]) {
  snprintf(path, 300, "%s/%s", run_folder, name);
}

static void write_text(const char *name, const char *text) {
  char path[300];
  path_of(name, path);
  OK(abbe_file_write(path, text, strlen(text), &error));
}

static void write_picture(const char *name) {
  static const char *const names[] = {"R", "G", "B", "x" EVIL "\nforged 1 1 1"};
  char path[300];
  path_of(name, path);
  MADE(abbe_image, image, abbe_image_make(4, 4, 4, names, &image, &error));
  for (int i = 0; i < 64; i++) image.data[i] = 0.5f;
  OK(abbe_image_set_attribute(&image, "note" EVIL, "a\n" EVIL "\r" EVIL, &error));
  OK(abbe_exr_write(path, &image, &error));
}

/* YAML's own escapes: a file of it holds no control characters. */
#define YAML_EVIL "\\e[31m\\a\\x7f\\x9b\\n"

static void write_scene(const char *name, const char *rest) {
  char text[2000];
  snprintf(
      text, sizeof text,
      "camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05], size: [8, 6]}\n"
      "lights:\n- {name: \"la" YAML_EVIL
      "mp\", kind: point, position: [0.05, 0.03, 0.6], intensity: 1}\n"
      "objects:\n- {name: \"fl" YAML_EVIL
      "oor\", shape: rectangle, width: 2, height: 2, reflectance: 0.5}\n- {name: \"ba" YAML_EVIL
      "ll\", shape: sphere, radius: 0.04, transform: [{translate: [0, 0, 0.2]}], material: "
      "n-bk7}\n%s",
      rest);
  write_text(name, text);
}

static void prepare(void) {
  write_picture("evil.exr");
  write_picture("na" EVIL "me.exr");
  write_scene("names.yaml", "");
  write_scene("key.yaml", "\"od" YAML_EVIL "d\": 1\n");
  write_scene("material.yaml",
              "- {name: x, shape: sphere, radius: 0.01, material: \"no" YAML_EVIL "ne\"}\n");
  write_scene("mesh.yaml", "- {name: x, mesh: \"no" YAML_EVIL "ne.obj\", material: n-bk7}\n");
  write_scene("broken.yaml", "  - [\x01\x1b[31m");
  write_text("table.yaml",
             "description: \"de" YAML_EVIL "scribed\"\nmaterials:\n"
             "- {name: good, model: constant, coefficients: [1.5], source: \"so" YAML_EVIL
             "urce\", description: \"de" YAML_EVIL "s\"}\n");
  write_text("bad_name.yaml", "materials:\n- {name: \"na\\x9b31m\", model: constant, coefficients: "
                              "[1.5], source: made up}\n");
  write_text("power.csv", "400 1\n500 " EVIL "\n");
  write_text("points.csv", "wl,n\n0.5,1.5\n0.6," EVIL "\n");
  write_text("evil.ocio", "ocio_profile_version: 2\nroles: {scene_linear: ap0}\n"
                          "file_rules:\n  - !<Rule> {name: Default, colorspace: ap0}\n"
                          "displays:\n  \"mo" YAML_EVIL "n\":\n"
                          "    - !<View> {name: \"vi" YAML_EVIL "ew\", colorspace: ap0}\n"
                          "colorspaces:\n"
                          "  - !<ColorSpace> {name: ap0, \"un" YAML_EVIL "known\": 3}\n");
  write_text("broken.ocio", "ocio_profile_version: 2\n" EVIL ": [\n");
}

static void begin(void) {
  assert_non_null(setlocale(LC_CTYPE, "C.UTF-8"));
  run_setup();
}

GROUP(begin, run_teardown);

TEST(everything_that_is_said) {
  static const char *const lines[] = {
      "$abbe info evil.exr",
      "$abbe info \"na\"*me.exr",
      "$abbe info --json evil.exr",
      "$abbe compare evil.exr evil.exr",
      "$abbe compare evil.exr evil.exr --json",
      "$abbe display evil.exr -o x.png --layer \"$evil\"",
      "$abbe display evil.exr -o x.png --ocio broken.ocio",
      "$abbe display evil.exr -o x.png --ocio evil.ocio --view \"$evil\"",
      "$abbe display --list --ocio evil.ocio",
      "$abbe plan names.yaml",
      "$abbe plan names.yaml --json",
      "$abbe plan names.yaml --map-light \"$evil\"",
      "$abbe plan key.yaml",
      "$abbe plan material.yaml",
      "$abbe plan mesh.yaml",
      "$abbe plan broken.yaml",
      "$abbe plan \"$evil.yaml\"",
      "$abbe trace names.yaml --spp 1 --photons 16 --map 4 -q -o t.exr --stats t.json --json",
      "$abbe export names.yaml -o x.pov --svg \"$evil\"",
      "$abbe materials list --table table.yaml",
      "$abbe materials list --table table.yaml --json",
      "$abbe materials show good --table table.yaml",
      "$abbe materials show \"$evil\"",
      "$abbe materials list --table bad_name.yaml",
      "$abbe materials \"$evil\"",
      "$abbe materials check --table table.yaml",
      "$abbe materials fit --points points.csv",
      "$abbe materials import points.csv",
      "$abbe materials import evil.exr",
      "$abbe materials export --table table.yaml --format rii",
      "$abbe weights --illuminant power.csv",
      "$abbe weights --space \"$evil\"",
      "$abbe \"$evil\"",
      "$abbe info \"--$evil\"",
      "$abbe help \"$evil\"",
      "$abbe render names.yaml -o \"$evil.png\"",
      "$abbe render names.yaml --preset \"$evil\" -o x.exr",
  };
  prepare();
  for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
    const int code = run_line(printed("evil=\"$(printf '%s')\"; %s",
                                      "\\033]0;x\\007\\033[31m\\177\\302\\2331m\\2332m", lines[i]));
    if (run_output[0] == '\0' && run_errors[0] == '\0') fail_msg("%s says nothing", lines[i]);
    if (!is_printable(run_output) || !is_printable(run_errors))
      fail_msg("%s says what is not printable:\n%s%s", lines[i], run_output, run_errors);
    if (strstr(lines[i], "--json") == NULL) continue;
    assert_int_equal(code, 0);
    cJSON *json = cJSON_Parse(run_output);
    if (json == NULL) fail_msg("%s: this is no JSON:\n%s%s", lines[i], run_output, run_errors);
    cJSON_Delete(json);
  }
}

/* JSON that goes to a file is as good. */
TEST(json_in_files) {
  prepare();
  run_must("$abbe trace names.yaml --spp 1 --photons 16 --map 4 -q --stats t.json -o t.exr");
  char path[300];
  FREED char *text = NULL;
  size_t size = 0;
  path_of("t.json", path);
  OK(abbe_file_read(path, 1 << 20, &text, &size, &error));
  assert_true(is_printable(text));
  cJSON *json = cJSON_Parse(text);
  assert_non_null(json);
  cJSON_Delete(json);
}

/* What a text says keeps its letters, and its lines do not look like the program's own. */
TEST(what_is_shown) {
  prepare();
  run_says("$abbe info evil.exr",
           ": a\n    \xe2\x90\x9b]0;x\xe2\x90\x87\xe2\x90\x9b[31m\xe2\x90\xa1");
  assert_null(strstr(run_output, "\nforged"));
  run_says("$abbe plan names.yaml",
           "model: ba\xe2\x90\x9b[31m\xe2\x90\x87\xe2\x90\xa1\xef\xbf\xbd ll");
  run_must("$abbe info --json evil.exr");
  cJSON *json = cJSON_Parse(run_output);
  const cJSON *attributes = cJSON_GetObjectItem(json, "attributes");
  assert_non_null(attributes);
  const char *note = attributes->child->valuestring;
  assert_memory_equal(note, "a\n\x1b]0;x\x07\x1b[31m", 13); /* JSON has escapes for these */
  cJSON_Delete(json);
}

/* Letters of several bytes pass, though they come in pieces of any size. */
TEST(letters_pass) {
  static char text[40000];
  write_picture("evil.exr");
  char path[300];
  path_of("evil.exr", path);
  MADE(abbe_image, image, abbe_exr_read(path, &image, &error));
  /* Lines are short, for long ones are cut. */
  for (size_t used = 0, line = 0; used + 12 < sizeof text; line++) {
    const char *letters[] = {"a", "\xc3\xa9", "\xe2\x82\xac", "\xf0\x9f\x92\x8e", "\r\n"};
    const size_t which = line % 50 == 49 ? 4 : used % 7 % 5;
    used += (size_t)snprintf(text + used, 8, "%s", letters[which]);
  }
  OK(abbe_image_set_attribute(&image, "text", text, &error));
  OK(abbe_exr_write(path, &image, &error));
  run_must("$abbe info evil.exr");
  char *at = strstr(run_output, "text: ");
  assert_non_null(at);
  at += 6;
  for (const char *c = text; *c != '\0'; c++) {
    assert_int_equal(*at++, *c);
    if (*c == '\n') at += 4;
  }
}

/* A file of another kind is named as such, and not quoted. */
TEST(binary_for_text) {
  static const char *const lines[] = {
      "materials import",        "materials fit --points",
      "materials list --table",  "plan",
      "materials check --table", "materials plot n-bk7 -o x.png --points",
      "weights --illuminant"};
  static const unsigned char xls[600] = {0xd0, 0xcf, 0x11, 0xe0, 0xa1, 0xb1, 0x1a, 0xe1, 0,    0,
                                         0,    0,    0,    0,    0,    0,    0x3e, 0,    0x03, 0,
                                         0xfe, 0xff, 9,    0,    '1',  0xc0, ' ',  '2',  '\n', '3'};
  char path[300];
  path_of("book.xls", path);
  OK(abbe_file_write(path, xls, sizeof xls, &error));
  for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
    run_fails(printed("$abbe %s book.xls", lines[i]), 1, "book.xls");
    assert_contains(run_errors, "not a text file");
    assert_true(strlen(run_errors) < 200);
  }
}

/* An error where results should go is still seen. */
TEST(a_full_output) {
  prepare();
  run_fails("$abbe info evil.exr > /dev/full", 1, "No space left");
  run_fails("$abbe help > /dev/full", 1, "No space left");
}
