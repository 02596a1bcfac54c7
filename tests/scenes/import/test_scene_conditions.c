#include "tests/scenes/scene_text.h"

#include "scenes/check/scene_doubts.h"
#include "scenes/export/scene_export.h"

#define WARM(material)                                                                             \
  "temperature: 40\npressure: 0\ncamera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n" POINT_LIGHT  \
      FLOOR                                                                                        \
      BALL(material)
#define LINE_D_NM 587.5618

/* Of N-BK7 as [SchottTIE19]'s model has it: what renderer, tracer and exports ask for. */
TEST(glass_is_as_warm_as_the_scene) {
  OWNED(abbe_scene, scene) = scene_of(WARM("n-bk7") BRICK("air"));
  double n = 0;
  OK(abbe_material_n(scene.object[1].material, LINE_D_NM, &n, &error));
  assert_near(n, 1.5172435, 5e-8);
  OK(abbe_material_n(scene.object[2].material, LINE_D_NM, &n, &error));
  assert_near(n, 1, 0);
  abbe_export_index index;
  OK(abbe_export_index_make(scene.object[1].material, ABBE_EXPORT_FORM_ONE, LINE_D_NM, &index,
                            &error));
  assert_near(index.value[0], 1.5172435, 5e-8);
}

TEST(metals_are_said_to_stay_as_they_were_measured) {
  abbe_scene_doubts doubts;
  OWNED(abbe_scene, scene) =
      scene_of(WARM("n-bk7") "- {name: coin, shape: box, size: [0.1, 0.1, 0.01], transform: "
                             "[{translate: [0.4, 0, 0.2]}], mirror: gold}\n");
  abbe_scene_doubt(&scene, &doubts);
  assert_int_equal(doubts.count, 1);
  assert_contains(doubts.text[0], "'coin' has n and k of gold as they were measured, not at 40 C");
}

TEST(what_has_no_index_there_is_refused) {
  const struct {
    const char *text, *words;
  } refused[] = {
      {WARM("diamond"),
       "x.yaml:1: 'temperature': diamond has no index at 40 C: its record gives no dn/dT"},
      {"temperature: 293\n", "x.yaml:1: 'temperature: 293' is not in the range from -250 to 200"},
      {"pressure: 101325\n", "x.yaml:1: 'pressure: 101325' is not in the range from 0 to 100"}};
  for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
    abbe_scene scene;
    REFUSED(
        ABBE_SCHEMA, refused[i].words,
        abbe_scene_parse(refused[i].text, strlen(refused[i].text), "x.yaml", NULL, &scene, &error));
  }
}
