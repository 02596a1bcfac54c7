#include "cli/view/view_app.h"

#include "base/maths.h"
#include "cli/view/view_keep.h"
#include "colorimetry/screen/screen_file.h"

#include <stdio.h>

enum { LONGEST = 1100 };

static void name_of(const abbe_view_session *session, size_t frame, char out[LONGEST]) {
  char ending[48] = "-turn.png";
  if (frame > 0) snprintf(ending, sizeof ending, "-turn-%04zu.png", frame);
  abbe_view_keep_name(session, ending, out, LONGEST);
}

abbe_result abbe_view_turn_begin(abbe_view_session *session, abbe_error *error) {
  char name[LONGEST];
  name_of(session, 0, name);
  abbe_result result = abbe_view_keep_rests(session, error);
  if (result == ABBE_OK) result = abbe_view_keep_check(session, name, error);
  if (result != ABBE_OK) return result;
  session->turn_frame = 1;
  session->turn_serial = session->state.refine.serial;
  session->turned = false;
  return ABBE_OK;
}

bool abbe_view_turn_wants(const abbe_view_session *session, abbe_view_request *out) {
  if (session->turn_frame == 0 || session->turn_serial != session->state.refine.serial)
    return false;
  out->turns = true;
  out->turn_rad = 2 * ABBE_PI * (double)(session->turn_frame - 1) / ABBE_VIEW_TURN_FRAMES;
  out->job = (abbe_view_job){
      .stage = ABBE_VIEW_ACCURATE, .light = ABBE_VIEW_ACCURATE, .serial = session->turn_serial};
  return true;
}

/* All frames as one. */
static abbe_result write_moving(const abbe_view_session *session, abbe_error *error) {
  char name[LONGEST], frame[ABBE_VIEW_TURN_FRAMES][LONGEST];
  const char *list[ABBE_VIEW_TURN_FRAMES];
  for (size_t i = 0; i < ABBE_VIEW_TURN_FRAMES; i++) {
    name_of(session, i + 1, frame[i]);
    list[i] = frame[i];
  }
  name_of(session, 0, name);
  return abbe_screen_file_move(name, list, ABBE_VIEW_TURN_FRAMES, ABBE_VIEW_TURN_PER_SECOND, error);
}

void abbe_view_turn_take(abbe_view_session *session, const abbe_view_result *result) {
  char name[LONGEST];
  abbe_error error = {0};
  const size_t frame = session->turn_frame;
  if (result->outcome != ABBE_VIEW_DONE || session->turn_serial != session->state.refine.serial) {
    snprintf(session->note, sizeof session->note,
             "the turntable has ended after %zu frames%s%.900s", frame - 1,
             result->sentence[0] != '\0' ? ": " : "", result->sentence);
    session->turn_frame = 0;
    return;
  }
  name_of(session, frame, name);
  abbe_result written = abbe_view_keep_png(session, &result->picture, name, &error);
  if (written == ABBE_OK && frame < ABBE_VIEW_TURN_FRAMES) {
    snprintf(session->note, sizeof session->note, "turntable: %zu of %d", frame,
             ABBE_VIEW_TURN_FRAMES);
    session->turn_frame++;
    return;
  }
  if (written == ABBE_OK) written = write_moving(session, &error);
  session->turned = written == ABBE_OK;
  name_of(session, 0, name);
  if (session->turned)
    snprintf(session->note, sizeof session->note, "kept %.500s and its %d frames", name,
             ABBE_VIEW_TURN_FRAMES);
  else
    snprintf(session->note, sizeof session->note, "%s", error.text);
  session->turn_frame = 0;
}
