/* What workers draw: one picture, whichever draws it and whatever it has drawn before, and of light
 * that moves nothing of where it was. */
#include "tests/check.h"

#include "cli/view/work/view_worker.h"

HOLDS(abbe_view_worker);

enum { SIDE = 128 };

static abbe_view_worker *made(void) {
  abbe_view_worker *out = NULL;
  OK(abbe_view_worker_make(NULL, NULL, NULL, &out, &error));
  return out;
}

/* A stage of the gem with its lamp at that place, as few.txt of script/bench-view has it. */
static void give(abbe_view_worker *w, abbe_view_stage stage, bool warms, double x) {
  char path[] = ABBE_SOURCE_DIR "/scenes/gem.yaml";
  const abbe_view_document few = {.path = path, .photons = 96, .map_size = 256, .wavelengths = 9};
  abbe_view_request request = {
      .job = {.stage = stage, .light = stage, .warms = warms}, .width = SIDE, .height = SIDE};
  OK(abbe_view_document_copy(&few, &request.document, &error));
  OK(abbe_view_document_set(&request.document, "lights.lamp.position",
                            printed("[%.3f, 0.03, 0.295]", x), &error));
  abbe_view_worker_give(w, &request);
}

static abbe_view_result taken(abbe_view_worker *w) {
  abbe_view_result out = {0};
  while (!abbe_view_worker_take(w, &out)) abbe_view_worker_wait(w, 60);
  abbe_view_worker_wait(w, 60); /* for nothing */
  return out;
}

/* The picture; its first three channels are its colour. */
static abbe_image draw(abbe_view_worker *w, abbe_view_stage stage, bool warms, double x) {
  give(w, stage, warms, x);
  OWNED(abbe_view_result, result) = taken(w);
  if (result.outcome != ABBE_VIEW_DONE) fail_msg("%s", result.sentence);
  const abbe_image out = result.picture;
  result.picture = (abbe_image){0};
  return out;
}

static void leave(abbe_view_worker *w, abbe_view_stage stage, bool warms, double x) {
  OWNED(abbe_image, image) = draw(w, stage, warms, x);
}

TEST(whoever_draws_it_a_picture_is_the_same) {
  HELD(abbe_view_worker, a) = made(), *b = made();
  leave(a, ABBE_VIEW_MOVING, false, 0);
  leave(a, ABBE_VIEW_MOVING, false, 0.01);
  OWNED(abbe_image, one) = draw(a, ABBE_VIEW_BALANCED, false, 0.02);
  leave(b, ABBE_VIEW_MOVING, true, -0.01);
  give(b, ABBE_VIEW_BALANCED, false, 0.02); /* which is told to stop */
  abbe_view_worker_cancel(b);
  abbe_view_result result = taken(b);
  assert_true(result.outcome == ABBE_VIEW_CANCELLED || result.outcome == ABBE_VIEW_LOST);
  abbe_view_result_free(&result);
  OWNED(abbe_image, other) = draw(b, ABBE_VIEW_BALANCED, false, 0.02);
  assert_int_equal(one.channels, other.channels);
  assert_memory_equal(one.data, other.data,
                      one.width * one.height * one.channels * sizeof *one.data);
}

static double luminance(const abbe_image *image, int x, int y) {
  const float *v = &image->data[image->channels * ((size_t)y * SIDE + (size_t)x)];
  return 0.27 * (double)v[0] + 0.67 * (double)v[1] + 0.06 * (double)v[2];
}

/* Light that the picture has where another one has none so bright within three pixels. */
static double beyond(const abbe_image *image, const abbe_image *other) {
  enum { NEAR = 3 };
  double sum = 0;
  for (int y = 0; y < SIDE; y++)
    for (int x = 0; x < SIDE; x++) {
      double most = 0;
      for (int v = (int)fmax(0, y - NEAR); v <= (int)fmin(SIDE - 1, y + NEAR); v++)
        for (int u = (int)fmax(0, x - NEAR); u <= (int)fmin(SIDE - 1, x + NEAR); u++)
          most = fmax(most, luminance(other, u, v));
      sum += fmax(0, luminance(image, x, y) - most);
    }
  return sum;
}

/* Frames that follow one another are blended, each texel within what the last frame has around it
 * (gl/caustics/spectral_map.h), where a lamp moves as little as a hand does in a picture. A mean
 * without these bounds leaves 9 % of the light where it was. The fifth frame's photons start where
 * the first one's do, so without the frames before it both are the same. */
TEST(a_dragged_lamp_leaves_no_ghosts) {
  HELD(abbe_view_worker, a) = made(), *b = made();
  double was = 0, blended = 0, light = 0;
  leave(a, ABBE_VIEW_MOVING, false, 0);
  OWNED(abbe_image, now) = draw(b, ABBE_VIEW_MOVING, false, 0.04);
  for (int i = 1; i < 4; i++) {
    OWNED(abbe_image, before) = draw(a, ABBE_VIEW_MOVING, false, 0.01 * i);
    was += 0.25 * beyond(&before, &now);
  }
  OWNED(abbe_image, dragged) = draw(a, ABBE_VIEW_MOVING, false, 0.04);
  for (int i = 0; i < SIDE * SIDE; i++) {
    const double here = luminance(&now, i % SIDE, i / SIDE);
    blended += fabs(luminance(&dragged, i % SIDE, i / SIDE) - here);
    light += here;
  }
  const double ghosts = beyond(&dragged, &now);
  print_message("%.4f of the light that has moved is where it was; blending moves %.4f of all\n",
                ghosts / was, blended / light);
  assert_true(was > 0.01 * light && blended > 0.01 * light && ghosts < 0.02 * was);
}
