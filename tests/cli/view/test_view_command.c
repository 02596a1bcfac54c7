/* `abbe view`, led by scripts: the whole of it but the window. */
#include "tests/cli/run_program.h"

#define SCRIPTS "\"$house\"/tests/cli/view/scripts/"
/* light enough for what is asserted */
#define FEW "--photons 96 --map 256 --wavelengths 9 "
#define VIEW "\"$abbe\" view \"$house\"/scenes/gem.yaml " FEW

#ifdef ABBE_HAVE_VIEW

/* Opens the gem, turns it, makes it a diamond, drags the lamp, clicks the violet edge, keeps all.
 */
TEST(the_story) {
  run_must(VIEW "--size 532x256 --keep story --script " SCRIPTS "story.txt > said");
  /* the scene that was kept differs in what was changed, and draws the same picture */
  run_must("diff \"$house\"/scenes/gem.yaml story.yaml | grep -c '^>' > lines; grep -qx 4 lines");
  run_must("grep -q 'material: diamond' story.yaml && grep -q '# A cut stone' story.yaml");
  run_must("sed -n 's/^command abbe/\"$abbe\"/p' said > again.sh");
  run_must("grep -q -e '--set objects.gem.material=diamond' again.sh");
  run_must("echo \"$(cat again.sh) --backend cpu -q\" > again.sh && . ./again.sh");
  run_must("\"$abbe\" compare story-again.exr story.exr --tolerance relative_rmse=1e-6");
  run_must("cmp story-again.png story.png");
  /* keeping has said the same command */
  run_must("sed -n 's/^command //p' said > lines && grep -q -x -F -f lines said");
  run_clears("rm said lines again.sh story-again.exr story.exr story.yaml *.png");
}

TEST(what_is_wrong_is_said_and_the_picture_stays) {
  run_must("cp \"$house\"/scenes/sphere.yaml scene.yaml; cp scene.yaml good.yaml");
  run_must("sed 's/radius:/radios:/' good.yaml > broken.yaml");
  run_must("sed 's/^ambient:.*/ambient: 1.5/' good.yaml > bright.yaml");
  run_must(
      "sed '/- name: ball/,/material:/d' good.yaml > empty.yaml && ! grep -q radius: empty.yaml");
  run_must("sed \"s/name: ball/name: 'ball, of##x'/\" good.yaml > renamed.yaml");
  run_must("\"$abbe\" view scene.yaml " FEW "--last balanced --size 500x200 --script " SCRIPTS
           "faults.txt");
  /* a name that Dear ImGui would not show to its end is another in the panel */
  run_must("cmp first.png good.png && ! cmp -s first.png renamed.png");
  run_must("rm *.yaml *.png");
  run_clears(VIEW "--last balanced --size 500x200 --script " SCRIPTS "refused.txt");
}

/* The design is one of the scene's files: it is read again when it changes, and the scene is kept
 * beside it as it was, however that folder is written; elsewhere it names the design by its whole
 * path, and so does the scene that is made of a stone's file. */
TEST(a_design_is_a_file_of_the_scene) {
  run_must("mkdir in out && cp \"$house\"/scenes/designs/step-square.asc in/a.asc && \"$abbe\" gem "
           "retarget in/a.asc --crown 38 -o in/b.asc -q && sed 's/shape: gem/shape: cut/; "
           "s/girdle:.*/file: a.asc/; s/table:.*/width: 0.05/; /sides:/d; /crown:/d; /pavilion:/d' "
           "\"$house\"/scenes/gem.yaml > in/cut.yaml");
  run_must("printf '%s\\n' 'wait balanced' 'key control+s' 'say note' 'remember hash first' 'copy "
           "in/b.asc in/a.asc' 'wait changed' 'wait balanced' 'assert hash != $first' > a.txt");
  run_must("\"$abbe\" view in/cut.yaml " FEW
           "--last balanced --size 420x64 --keep \"$PWD/in/kept\" --script a.txt && cmp "
           "in/cut.yaml in/kept.yaml");
  run_must(
      "printf '%s\\n' 'wait balanced' 'key control+s' 'assert note contains kept' 'say command' "
      "> a.txt");
  run_must("\"$abbe\" view in/cut.yaml " FEW
           "--last balanced --size 420x64 --keep out/kept --script a.txt && grep -q \"file: ."
           "$PWD/in/a.asc\" out/kept.yaml && \"$abbe\" plan out/kept.yaml >/dev/null");
  run_must(
      "\"$abbe\" view in/a.asc --material quartz --look velvet " FEW
      "--last balanced --size 420x64 --keep out/stone --script a.txt > said && grep -q \"file: ."
      "$PWD/in/a.asc\" out/stone.yaml && \"$abbe\" plan out/stone.yaml >/dev/null");
  run_must("grep -q '^command abbe render in/a.asc --material quartz --look velvet' said");
  /* no file can be written in a folder that is gone */
  run_must("mkdir gone home && p=$PWD && cd gone && rmdir ../gone && HOME=$p/home \"$abbe\" view "
           "$p/in/cut.yaml " FEW "--last balanced --size 420x64 --script $p/a.txt && test -s "
           "$p/home/cut-view.png && \"$abbe\" plan $p/home/cut-view.yaml >/dev/null");
  run_clears("rm -r in out home said a.txt");
}

/* Its sliders begin at its own angles; the same angles are set for other commands. */
TEST(a_design_is_recut) {
  run_must("cp \"$house\"/scenes/designs/step-square.asc . && sed 's/shape: gem/shape: cut/; "
           "s/girdle:.*/file: step-square.asc/; s/table:.*/width: 0.05/; /sides:/d; /crown:/d; "
           "/pavilion:/d' \"$house\"/scenes/gem.yaml > cut.yaml");
  run_must("\"$abbe\" view cut.yaml --last moving --size 420x300 --script " SCRIPTS "recut.txt");
  run_must("! cmp -s recut.png own.png && rm *.png");
  run_must("\"$abbe\" plan cut.yaml --set objects.gem.crown=38 > /dev/null");
  run_fails("\"$abbe\" plan cut.yaml --set objects.gem.crown=95", 1, "between 0 and 90 degrees");
  run_clears("rm cut.yaml step-square.asc");
}

/* Side by side and both in view, however narrow; each is judged and dragged by itself, and the
 * report is of the first as it is cut now. */
TEST(two_stones_and_a_report) {
  run_must("cp \"$house\"/scenes/designs/step-square.asc a.asc && cp \"$house\"/scenes/designs/"
           "brilliant-quartz.asc b.asc");
  run_must(
      "printf '%s\\n' 'wait moving' 'slide \"stone 1 crown angle\" 0.4' 'wait balanced' 'wait "
      "rest' 'assert "
      "light_return > 0.1' 'assert return_by_pavilion != 0' 'wheel \"stone 1 pavilion angle\" 0' "
      "'assert hinted = 2' 'wheel 20,20 0' 'assert hinted = 0' "
      "'click report' 'wait rest' 'assert note contains k-report.pdf' "
      "'drag \"handle:stone 2\" 30,160' 'assert \"objects.stone 2.transform\" contains translate' "
      "'drag \"handle:stone 1\" 30,60 control' 'assert \"objects.stone 1.transform\" contains "
      "rotate' 'assert undo = 3' > "
      "a.txt");
  run_must("\"$abbe\" view a.asc b.asc --material quartz --photons 16 --map 64 --wavelengths 3 "
           "--last balanced --size 440x200 --keep k --script a.txt");
  run_must("grep -q %%EOF k-report.pdf && \"$abbe\" gem info k-cut.asc > lines && test -s k.png");
  /* a design of the report's own name is not cut over */
  run_must(
      "printf '%s\\n' 'wait moving' 'click report' 'assert note contains \"k-cut.asc is what\"' > "
      "a.txt; \"$abbe\" view k-cut.asc --photons 16 --map 64 --wavelengths 3 --last moving "
      "--size 380x200 --keep k --script a.txt");
  run_clears("rm a.* b.asc k* lines");
}

TEST(what_is_shown_beside_the_picture) {
  run_must(VIEW "--last accurate --size 640x300 --script " SCRIPTS "shown.txt > said");
  /* pictures of which no two are alike */
  run_must("test $(cat caustic.png luminance.png distance.png map.png | wc -c) -gt 8000");
  run_must("test $(md5sum caustic.png luminance.png distance.png map.png bright.png | cut -c1-32 | "
           "sort -u | wc -l) = 5");
  /* what is kept is what was looked at: luminance, distances */
  run_must("! cmp -s kept.png kept-distance.png && test -s gem-view.exr");
  run_must("grep -q -e \"--display sRGB --view Plain --exposure 1\" said");
  run_clears("rm *.png gem-view.exr gem-view.yaml said");
}

/* A whole turn comes back to where it began, and what stood stands again. */
TEST(a_turntable) {
  run_must("printf '%s\\n' 'wait accurate' 'remember hash first' 'key t' 'wait turntable' 'assert "
           "note contains a-turn.png' 'wait accurate' 'assert hash = $first' 'key control+s' 'key "
           "t' 'wheel 20,20 1' 'wait accurate' 'assert turning = no' > a.txt");
  run_must("\"$abbe\" view \"$house\"/scenes/sphere.yaml " FEW
           "--last accurate --size 404x64 --keep a --script a.txt");
  run_must("test $(ls a-turn-0*.png | wc -l) = 36 && cmp a-turn-0001.png a.png");
  run_must("! cmp -s a-turn-0001.png a-turn-0019.png; grep -q acTL a-turn.png");
  run_clears("rm a*");
}

/* What was drawn in a context that is lost is drawn again in another, to the bit. */
TEST(a_lost_context_is_made_good) {
  run_must("cp \"$house\"/scenes/sphere.yaml good.yaml");
  run_must("ABBE_LOST=lost LD_PRELOAD=" ABBE_LOST_CONTEXT " \"$abbe\" view good.yaml " FEW
           "--last accurate --size 500x200 --script " SCRIPTS "lost.txt");
  assert_contains(run_errors, "lost_context: a context is lost");
  run_clears("rm good.yaml lost");
}

/* The sun is dragged, and caustics are looked up there; rendering by the command that is said gives
 * the same picture. */
TEST(caustics_are_looked_up) {
  run_must("cp \"$house\"/docs/examples/ball.yaml ball.yaml && \"$abbe\" volume ball.yaml -o v.exr "
           "--shells 6x12x12 --photons 20000 --passes 1 -q");
  run_must("printf '%s\\n' 'wait accurate' 'remember hash first' 'drag handle:sun 30,40' 'wait "
           "accurate' 'assert hash != $first' 'key control+s' 'say command' > a.txt");
  run_must("\"$abbe\" view ball.yaml --volume v.exr --last accurate --size 440x80 --keep a "
           "--script a.txt > said");
  run_must("sed -n 's/^command abbe/\"$abbe\"/p' said > again.sh");
  run_must("grep -q -e '--volume .*--set .lights.sun.direction' again.sh");
  run_must("echo \"$(cat again.sh) --backend cpu -q\" > again.sh && . ./again.sh");
  run_must("\"$abbe\" compare a-again.exr a.exr --tolerance relative_rmse=1e-6");
  run_clears("rm ball.yaml a* said v.exr");
  assert_true(
      run_refuses(VIEW "--volume \"$house\"/scenes/gem.yaml --script /dev/null", 1, "gem.yaml: "));
}

/* Neither the scene nor the table beside it is lost by keeping, whatever the name is. */
TEST(what_is_read_is_not_written_over) {
  run_must("mkdir scenes; cp \"$house\"/scenes/sphere.yaml scenes/gem.yaml");
  run_must("cp scenes/gem.yaml other-view.yaml; ln scenes/gem.yaml link.yaml");
  run_must("cp scenes/gem.yaml before.yaml");
  run_fails("\"$abbe\" view scenes/gem.yaml --keep scenes/gem --script /dev/null", 2,
            "--keep scenes/gem would write over scenes/gem.yaml");
  run_fails("\"$abbe\" view scenes/gem.yaml --keep ./link --script /dev/null", 2,
            "choose another name");
  run_fails("\"$abbe\" view scenes/gem.yaml --keep scenes/ --script /dev/null", 2,
            "names no files");
  /* another scene than at the start, picked in the panel, is kept under its own name; back at the
   * first one that would be written over */
  run_must(
      "printf '%s\\n' 'wait balanced' 'choose scene other-view.yaml' 'wait balanced' 'slide "
      "exposure 0.6' 'key control+s' 'assert note contains other-view-view.exr' 'key control+z' "
      "'wait balanced' 'assert scene = other.yaml' 'key control+s' 'assert note contains lost' "
      "'key control+y' 'wait balanced' 'assert scene = other-view.yaml' > a.txt");
  run_must("cp before.yaml other.yaml; \"$abbe\" view other.yaml " FEW
           "--last balanced --size 420x600 --script a.txt");
  /* what is no scene is not to be picked */
  run_must("cp \"$house\"/scenes/water/clear-water.yaml table.yaml; printf 'choose scene "
           "table.yaml' > a.txt");
  run_fails("\"$abbe\" view other.yaml --last moving --size 420x600 --script a.txt", 1,
            "there is no 'table.yaml' in sight");
  run_must("cmp before.yaml other-view.yaml && cmp before.yaml scenes/gem.yaml");
  run_must("test ! -e other-view.exr && test ! -e scenes/gem.exr");
  run_clears("rm -r scenes *.yaml a.txt other-view-view.exr other-view-view.png");
}

TEST(scripts_that_do_not_hold) {
  static const struct {
    const char *line, *sentence;
    int code;
  } cases[] = {{"assert stage = mean", "stage is 'none', not = 'mean'", 3},
               {"\n\nwhistle", "a.txt:3: whistle: is no command", 1},
               {"assert nothing = 1", "there is no value 'nothing'", 1},
               {"wait mean", "'mean' has not come, and nothing is left to do", 3},
               {"wait forever", "'forever' is no stage", 1},
               {"wait -1", "'-1' is no stage", 1},
               {"drag 5,5 6,6 shfit", "'shfit' is none of", 1},
               {"click 5,5 for 1", "'for' is none of", 1},
               {"drag 5,5 6,6 for ever", "for how many seconds", 1},
               {"click nowhere", "there is no 'nowhere' in sight", 1},
               {"click 360,5", "'360,5' lies outside of the window", 1},
               {"wheel -1,5 1", "'-1,5' lies outside of the window", 1},
               {"assert stage like none", "'like' is none of", 1},
               {"size 0x5", "WxH", 1},
               {"key control+s", "", 0}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    const char *line = printed("printf '%s\\n' > a.txt", cases[i].line);
    run_must(line);
    const int code = run_line(
        "\"$abbe\" view \"$house\"/scenes/sphere.yaml --last moving --size 360x40 --script a.txt");
    if (code != cases[i].code) fail_msg("'%s' ends with %d: %s", line, code, run_errors);
    assert_contains(run_errors, cases[i].sentence);
  }
  run_must("echo wait balanced > a.txt");
  run_fails("\"$abbe\" view \"$house\"/scenes/sphere.yaml --size 256x200 --script a.txt", 1,
            "no room for a picture; --size makes the window wide");
  run_clears("rm a.txt");
}

/* A pixel of the window is that of the file: two for each of its, the first at the upper left. */
TEST(pictures_are_looked_at) {
  run_must(
      "\"$abbe\" render \"$house\"/scenes/sphere.yaml --size 48x32 --bands 8 --photons 48 --map "
      "64 -q -o bands.exr --png bands.png");
  run_must(
      "printf '%s\\n' 'wait rest' 'assert width = 48' 'assert bands = 8' 'assert infinite = 0' "
      "'click 41,33' 'say Y x y' 'choose shown \"colour of the bands\"' 'say Y x y' 'wait rest' "
      "'shot colour.png' 'key +' 'assert exposure = 0.5' 'wait rest' 'shot bright.png' 'choose "
      "shown \"one band\"' 'slide wavelength 1' 'wait rest' 'assert wavelength = 755' 'drag 20,20 "
      "60,40' 'assert pixels = 231' 'wheel 48,32 4' 'assert zoom > 4.8' 'drag 40,40 60,50 right' "
      "'assert rate > 0' 'key v' 'assert note contains \"it has no\"' 'key b' 'wait rest' 'assert "
      "picture = "
      "bands.png' 'assert shown = colour' 'key v' 'wait rest' 'assert note = \"\"' > a.txt");
  run_must("\"$abbe\" view bands.exr bands.png --size 436x64 --script a.txt > said");
  /* as `pixel` says of the channels and of the bands */
  run_must(
      "\"$abbe\" pixel bands.exr 20,16 > pixel && awk '/^  XYZ/ { print $3 }' pixel > is && awk "
      "'/^Y/ { printf \"%.6g\\n\", $2 }' said > said.Y && diff is said.Y");
  run_must("! cmp -s colour.png bright.png");
  /* lights that are given are those that the lists begin at */
  run_must("printf '%s\\n' 'wait rest' 'click 41,33' 'remember x lit' 'choose illuminant \"the "
           "same\"' 'wait rest' 'assert x != $lit' 'remember Y same' 'choose \"lit by\" \"not "
           "known\"' 'wait rest' 'assert Y != $same' > b.txt");
  run_must("\"$abbe\" view bands.exr --size 436x64 --lit-by D5000 --illuminant A --script b.txt");
  run_fails("\"$abbe\" view bands.exr --script a.txt --lit-by moon", 1, "moon");
  run_fails("\"$abbe\" view bands.exr --script a.txt --illuminant A", 1,
            "does not say which light it was made with");
  run_must("head -c 300 bands.exr > cut.exr");
  run_fails("\"$abbe\" view bands.exr cut.exr --script a.txt", 1, "cut.exr");
  run_fails("\"$abbe\" view bands.webp --script a.txt", 1, ".exr, .hdr, .pic, .png and .avif");
  run_clears("rm *.exr *.png a.txt b.txt said said.Y is pixel");
}

TEST(without_a_display) {
  assert_true(
      run_refuses("env -u DISPLAY -u WAYLAND_DISPLAY " VIEW, 1, "--script leads the viewer"));
}

#else

TEST(it_says_what_to_install) {
  assert_true(run_refuses(VIEW, 1, "install libglfw3-dev and libimgui-dev"));
}

#endif

TEST(wrong_use) {
  assert_true(run_refuses("\"$abbe\" view", 2, "which scene?"));
  assert_true(run_refuses(VIEW "--size 0x1", 2, "--size"));
  assert_true(run_refuses(VIEW "--last soon", 2, "--last"));
  assert_true(run_refuses(VIEW "--photons 0", 2, "--photons"));
  assert_true(run_refuses(VIEW "--wavelengths few", 2, "--wavelengths"));
  assert_true(run_refuses(VIEW "--map 5000", 2, "--map"));
  assert_true(run_refuses(VIEW "--serve 65536", 2, "--serve"));
  assert_true(run_refuses(VIEW "a.exr", 2, "leave out"));
  assert_true(run_refuses("\"$abbe\" view a.exr --last moving", 2, "leave out --last"));
  assert_true(run_refuses(VIEW "--observer 1964", 2, "pictures of bands"));
  assert_true(run_refuses(VIEW "--serve 0 --script a.txt", 2, "not both"));
}

GROUP(run_setup, run_teardown);
