/* What people do wrong in their first hour, and the sentence that each gets: what is wrong, where,
 * and what to do. */
#include "tests/cli/run_program.h"

#define RENDER "\"$abbe\" render "
#define QUARTZ "cp \"$house\"/scenes/designs/brilliant-quartz.asc round.asc; "

/* A scene of a table, a lamp and a stone, with one thing changed by sed. */
#define SCENE(change)                                                                              \
  QUARTZ "sed -E '" change "' >my.yaml <<'END'\n"                                                  \
         "camera: {eye: [0, -3cm, 3cm], target: [0, 0, 3mm], fov: 20, size: [16, 16]}\n"           \
         "lights: [{name: lamp, kind: point, position: [0, 0, 0.3], intensity: 0.1}]\n"            \
         "objects:\n"                                                                              \
         "  - {name: table, shape: rectangle, width: 0.3, height: 0.3, reflectance: 0.5}\n"        \
         "  - {name: stone, shape: cut, file: round.asc, width: 6.5mm, stand: [0, 0, 0], "         \
         "material: ruby}\n"                                                                       \
         "END\n"
#define PLAN "\"$abbe\" plan my.yaml >/dev/null"
#define FEW " --photons 32 --map 64 "
#define PNG RENDER "my.yaml" FEW "--png a.png"

static const struct wrong {
  const char *line, *says;
  int code;
} wrongs[] = {
    /* commands */
    {RENDER, "which scene? Give a file such as scenes/gem.yaml, or a stone's such as round.asc", 2},
    {"\"$abbe\" rendr round.asc", "there is no command 'rendr'; did you mean 'render'?", 2},
    {"\"$abbe\" help rendr", "there is no command 'rendr'; did you mean 'render'?", 2},
    {"\"$abbe\" gem reprot round.asc", "there is no verb 'reprot'; did you mean 'report'?", 2},
    {QUARTZ RENDER "rond.asc",
     "rond.asc: cannot be opened: No such file or directory; did you mean 'round.asc'?", 1},
    {QUARTZ RENDER "./rond.asc", "did you mean './round.asc'?", 1},
    {QUARTZ RENDER "round.asc --materail ruby",
     "there is no option '--materail'; did you mean '--material'?", 2},
    {QUARTZ RENDER "round.asc --material rubi",
     "the table 'default' has no material 'rubi'; did you mean 'ruby'?", 1},
    {QUARTZ RENDER "round.asc --material gold",
     "'gold' is a metal; a stone is of something that light passes, such as ruby", 1},
    {QUARTZ RENDER "round.asc --look wite",
     "--look 'wite' is not known; did you mean 'white'? It is one of white, black, velvet", 2},
    {QUARTZ RENDER "round.asc --with rings", "did you mean 'ring'? It is one of table, ring, none",
     2},
    {QUARTZ RENDER "round.asc --width 6.5mn",
     "--width '6.5mn' is not a length from 0.001mm to 1000m: write it with its unit, such as 6.5mm "
     "or 0.2in (um, mm, cm, m, in, ft); a bare number is of mm",
     2},
    {QUARTZ RENDER "round.asc --width 6,5mm", "--width '6,5mm' is not a length", 2},
    {QUARTZ RENDER "round.asc --size 512", "--size '512' is not a size such as 512x512", 2},
    {QUARTZ RENDER "round.asc --png round.tif",
     "--png writes a .png file, and 'round.tif' ends like another kind; name it 'round.png'", 2},
    {QUARTZ RENDER "round.asc -o round.tif",
     "name it 'round.exr', or take --png for a picture to look at", 2},
    {QUARTZ RENDER "round.asc --turntable 8 -o round.mp4",
     "-o 'round.mp4' is a film, which ffmpeg makes of numbered frames; a .webp or .gif moves by "
     "itself",
     2},
    {QUARTZ RENDER "round.asc -o round.gif --png round.png",
     "'round.gif' and 'round.png' are two pictures for a display; name one", 2},
    {QUARTZ RENDER "round.asc -o round.gif --alpha",
     "GIF holds no transparency here; .png and .webp do", 2},
    {QUARTZ RENDER "round.asc -o round.gif --bits 16", "a file of kind GIF has 8 bits, not 16", 2},
    {QUARTZ RENDER "round.asc --png missing/round.png",
     "missing/round.png: cannot be written, for its folder is not there; make it first", 1},
    {QUARTZ RENDER "round.asc photo.jpg", "one scene at a time: 'round.asc' and 'photo.jpg'", 2},
    {RENDER "photo.jpg", "'photo.jpg' is neither a scene (.yaml) nor a stone's file (.asc", 2},
    {RENDER "ring.step", "let the program that made it export one of these", 2},
    {QUARTZ RENDER "round.asc --metal platinum",
     "a metal is for a ring or a setting: add --with ring or --setting prongs", 1},
    {QUARTZ RENDER "round.asc --setting prong", "did you mean 'prongs'? It is one of prongs, bezel",
     2},
    {QUARTZ RENDER "round.asc --with ring --metal ruby", "'ruby' is no metal; a ring is of one", 1},
    {QUARTZ RENDER "round.asc --with ring --metal platinium", "did you mean 'platinum'?", 1},
    {QUARTZ RENDER "round.asc --with ring --metal white-gold-18k",
     "no material 'white-gold-18k', for white gold is worn plated: take 'rhodium'", 1},
    {QUARTZ RENDER "round.asc round.asc --with ring", "a ring holds one stone, not 2", 1},
    {QUARTZ RENDER "round.asc --save-scene round.asc",
     "would be written over the argument 'round.asc', which is read; name another file", 2},
    {QUARTZ RENDER "round.asc --set objects.stone.file=missing.asc", "round.asc's scene:", 1},
    {QUARTZ RENDER "round.asc --alpha --turntable 8", "--alpha is of one picture", 2},
    {QUARTZ "\"$abbe\" trace round.asc --alpha --set camera.aperture=16",
     "of a traced picture is of a camera that is sharp", 1},
    {QUARTZ RENDER "round.asc --max-error 5 --tool trace --alpha --set camera.aperture=16",
     "of a traced picture is of a camera that is sharp", 1},
    {QUARTZ "\"$abbe\" view rond.asc", "did you mean 'round.asc'?", 1},
    {QUARTZ "\"$abbe\" gem report round.asc --material rubi",
     "the table 'default' has no material 'rubi'; did you mean 'ruby'?", 1},
    {SCENE("") "\"$abbe\" gem info my.yaml",
     "'my.yaml' is no design that is known by its name: they end with .asc", 1},
    /* stones' files */
    {": >empty.asc; " RENDER "empty.asc",
     "empty.asc: there is no facet in it; a design in GemCad's text has lines such as 'a 42.0 "
     "0.7045 96 n B 84 72'",
     1},
    {"printf nothing >a.stl; " RENDER "a.stl", "a.stl: line 1: 'solid' belongs here", 1},
    {"printf 'GemCad 5.0\\n' >a.gem; " RENDER "a.gem",
     "a.gem: it is GemCad's text, whose name ends with .asc; rename it", 1},
    {QUARTZ "sed '/^a -4/d' round.asc >open.asc; " RENDER "open.asc",
     "open.asc: the planes leave the stone open below: the pavilion lacks facets", 1},
    {QUARTZ "sed 's/^g 96/g 0/' round.asc >gear.asc; " RENDER "gear.asc",
     "a gear has 1 to 10000 teeth", 1},
    {"printf 'v 0 0 0\\nv 1 0 0\\nv 0 1 0\\nf 1 2 3\\n' >flat.obj; " RENDER "flat.obj",
     "flat.obj: it is flat; a stone has a volume", 1},
    /* scenes */
    {SCENE("") RENDER "my.yaml", "where to? Give -o FILE.exr, --png FILE.png or both", 2},
    {SCENE("s/material/materail/") PNG,
     "my.yaml:5: the key 'material' is missing here, and 'materail' is no key; did you mean "
     "'material'?",
     1},
    {SCENE("s/shape: cut/shpae: cut/") PNG,
     "my.yaml:5: the key 'shape' is missing here, and 'shpae' is no key; did you mean 'shape'?", 1},
    {SCENE("s/shape: cut/shape: cutt/") PNG,
     "my.yaml:5: 'shape: cutt' is not known; did you mean 'cut'? It is one of sphere, ring", 1},
    {SCENE("s/objects/object/") PNG,
     "my.yaml:3: a scene has no key 'object'; did you mean 'objects'?", 1},
    {SCENE("s/6.5mm/6.5 m m/") PNG,
     "my.yaml:5: 'width: 6.5 m m' is not a finite number, of metres or with its unit behind it", 1},
    {SCENE("s/ width: 6.5mm,//") PNG, "my.yaml:5: the key 'width' is missing here", 1},
    {SCENE("s/round.asc/rond.asc/") PNG, "my.yaml:5: rond.asc: cannot be opened: No such file", 1},
    {SCENE("s/^  - .name: stone/\\t- {name: stone/") PNG,
     "my.yaml:5: the line begins with a tab; YAML indents by blanks", 1},
    {SCENE("s/material: ruby/material: rubyy/") PNG,
     "my.yaml:5: the table 'default' has no material 'rubyy'; did you mean 'ruby'?", 1},
    {SCENE("s/material: ruby/material: gold/") PNG,
     "say 'mirror: gold' in place of 'material: gold'", 1},
    {SCENE("s/, material: ruby//") PNG, "my.yaml:5: an object has one of these: a 'material'", 1},
    {SCENE("s/reflectance: 0.5/reflectance: 50/") PNG,
     "my.yaml:4: 'reflectance: 50' is not in the range from 0 to 1", 1},
    {SCENE("s/, intensity: 0.1//") PNG, "my.yaml:2: the key 'intensity' is missing here", 1},
    {SCENE("s/kind: point/kind: lamp/") PNG,
     "my.yaml:2: 'kind: lamp' is not known; it is one of point, spot, directional", 1},
    {SCENE("/^lights/d") PNG,
     "the scene has no light; give it at least one under 'lights', or surroundings under "
     "'environment'",
     1},
    {SCENE("s/target: .0, 0, 3mm./target: [0, -3cm, 3cm]/") PNG,
     "my.yaml:1: the camera's 'eye' and 'target' are the same point", 1},
    {SCENE("s/fov: 20/fov: 200/") PNG, "my.yaml:1: 'fov: 200' is not in the range from 0.1 to 170",
     1},
    {SCENE("s/fov: 20/fov: 20, exposure: bright/") PNG,
     "my.yaml:1: 'exposure' is 'auto' or stops such as 1.5, not 'bright'", 1},
    {SCENE("s/fov: 20/fov: 20, exposure: auto/") PNG " --turntable 2",
     "'exposure: auto' is of one picture", 2},
    {SCENE("s/eye: .0, -3cm, 3cm./eye: 3cm/") PNG,
     "my.yaml:1: 'eye' wants a list of 3 lengths, not a word", 1},
    {SCENE("s/objects:/objects/") PNG, "is not well-formed YAML: could not find expected ':'", 1},
    {SCENE("s/position: .0, 0, 0.3/position: [0, 0, 2mm/") PNG,
     "the light 'lamp' is inside the refractor 'stone' (line 5)", 1},
    {SCENE("") RENDER "my.yaml --look black --png a.png", "--look is for a stone's file (.asc", 2},
    {SCENE("") RENDER "my.yaml --set objects.ston.width=8mm --png a.png",
     "'objects.ston.width': there is no 'ston'; did you mean 'stone'?", 1},
    {SCENE("") RENDER "my.yaml --set width --png a.png",
     "'width' sets nothing; write KEY=VALUE, such as camera.fov=30", 1},
    /* what can be done and is hardly meant */
    {SCENE("s/name: stone/name: table/") PLAN,
     "warning: two objects are called 'table' (lines 4 and 5)", 0},
    {SCENE("s/-3cm, 3cm/-30, 30/") PLAN,
     "warning: the camera's eye is 42.4 m away from 'stone', which is 0.011 pixels large", 0},
    {SCENE("s/stand: .0, 0, 0./stand: [0, 0, -2mm]/") PLAN,
     "mm deep in 'table': 'stand: [x, y, z]'", 0},
    {SCENE("s/position: .0, 0, 0.3/position: [0, 0, -0.3/") PLAN,
     "warning: the light 'lamp' reaches nothing that refracts or reflects: 'table' stands between",
     0},
    {SCENE("s/intensity: 0.1/intensity: 100/") PNG,
     "% of the picture is over-exposed: white without detail; --exposure -", 0},
};

GROUP(run_setup, run_teardown);

TEST(every_mistake_gets_its_sentence) {
  size_t wrong = 0;
  for (size_t i = 0; i < sizeof wrongs / sizeof *wrongs; i++) {
    const struct wrong *w = &wrongs[i];
    const int code = run_line(w->line);
    if (code != w->code || strstr(run_errors, w->says) == NULL) {
      print_error("%s\nends with %d, not %d; '%s' is expected in:\n%s\n", w->line, code, w->code,
                  w->says, run_errors);
      wrong++;
    }
    run_each(run_remove, NULL);
  }
  assert_int_equal(wrong, 0);
}

/* Files on the command line count from where the user stands, and ~ is the user's folder. */
TEST(files_count_from_here) {
  assert_int_equal(
      run_line(SCENE(
          "s/round.asc/nowhere.asc/") "mkdir sub; mv my.yaml sub; cp round.asc sub/o.asc;\"$abbe\" "
                                      "plan sub/my.yaml --set objects.stone.file=round.asc "
                                      ">/dev/null &&\"$abbe\" plan sub/my.yaml --set "
                                      "objects.stone.file=o.asc >/dev/null &&HOME=$PWD \"$abbe\" "
                                      "plan sub/my.yaml --set objects.stone.file=~/round.asc "
                                      ">/dev/null; code=$?; rm -r sub; exit $code"),
      0);
  run_each(run_remove, NULL);
}

/* The scene that is saved draws the picture that was drawn, bit for bit. */
TEST(a_saved_scene_draws_the_same) {
  const int code = run_line(
      QUARTZ "mkdir sub; " RENDER
             "round.asc --look velvet --size 24x24 -q --save-scene sub/my.yaml" FEW
             "-o a.exr && test ! -e round.png && " RENDER "sub/my.yaml --size 24x24 -q" FEW
             "-o b.exr && \"$abbe\" compare a.exr b.exr --json | tr -d ' \\t\\n' | grep -q "
             "'\"relative_rmse\":{\"value\":0,'; code=$?; rm -r sub; exit $code");
  if (code != 0) fail_msg("%s", run_errors);
  run_each(run_remove, NULL);
}

TEST(a_picture_is_named_after_its_stone) {
  run_must(QUARTZ RENDER "round.asc --size 16x16" FEW "--with none --alpha && test -s round.png");
  /* the renderer's picture is sharp, and so is its alpha */
  run_must(QUARTZ RENDER "round.asc --size 16x16" FEW
                         "--with none --alpha --set camera.aperture=16 && test -s "
                         "round.png");
  assert_contains(run_errors, "round.asc as quartz, 6.5 mm wide (its design is for an index of");
  run_each(run_remove, NULL);
}
