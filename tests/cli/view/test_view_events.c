/* What pages send: lines read, and a queue that keeps of them what is seen. */
#include "tests/check.h"

#include "cli/view/state/view_events.h"

static abbe_view_event event(const char *text) {
  char line[96];
  abbe_view_event e;
  snprintf(line, sizeof line, "%s", text);
  OK(abbe_view_event_read(line, &e, &error));
  return e;
}

static void add(abbe_view_events *q, const char *text) {
  const abbe_view_event e = event(text);
  assert_true(abbe_view_events_add(q, &e));
}

/* A thousand moves are one; what a drag, a key or a turn of the wheel must find stays in order. */
TEST(what_nobody_would_see_is_left_out) {
  static abbe_view_events q;
  abbe_view_event e;
  for (int i = 0; i < 1000; i++) add(&q, printed("move %d 7", i));
  assert_int_equal(q.count, 1);
  add(&q, "down 0");
  add(&q, "move 5 5");
  add(&q, "move 6 5");
  add(&q, "up 0");
  for (int i = 0; i < 300; i++) {
    add(&q, "move 6 5"); /* as pages do before each */
    add(&q, "wheel 1");
  }
  add(&q, "move 9 9");
  add(&q, "wheel -1");
  for (int i = 1; i < 50; i++) add(&q, printed("size %d 9", i));
  add(&q, "key + down");
  add(&q, "key + down"); /* another half stop */
  static const struct {
    abbe_view_event_kind kind;
    double x;
  } kept[] = {
      {ABBE_VIEW_EVENT_MOVE, 999}, {ABBE_VIEW_EVENT_BUTTON, 0}, {ABBE_VIEW_EVENT_MOVE, 6},
      {ABBE_VIEW_EVENT_BUTTON, 0}, {ABBE_VIEW_EVENT_MOVE, 6},   {ABBE_VIEW_EVENT_WHEEL, 100},
      {ABBE_VIEW_EVENT_MOVE, 9},   {ABBE_VIEW_EVENT_WHEEL, -1}, {ABBE_VIEW_EVENT_SIZE, 49},
      {ABBE_VIEW_EVENT_KEY, 0},    {ABBE_VIEW_EVENT_KEY, 0}};
  assert_int_equal(q.count, sizeof kept / sizeof *kept);
  for (size_t i = 0; i < sizeof kept / sizeof *kept; i++) {
    assert_true(abbe_view_events_take(&q, &e));
    assert_int_equal(e.kind, kept[i].kind);
    assert_true(e.x == kept[i].x);
  }
  assert_false(abbe_view_events_take(&q, &e));
}

/* As many as there may be wait in order, and no more. */
TEST(the_queue_has_an_end) {
  static abbe_view_events q;
  const abbe_view_event down = event("down 0"), up = event("up 1");
  abbe_view_event e;
  for (int i = 0; i < ABBE_VIEW_MOST_EVENTS; i++) assert_true(abbe_view_events_add(&q, &down));
  assert_false(abbe_view_events_add(&q, &up));
  for (int i = 0; i < 10; i++) assert_true(abbe_view_events_take(&q, &e));
  for (int i = 0; i < 10; i++) assert_true(abbe_view_events_add(&q, &up));
  assert_false(abbe_view_events_add(&q, &up));
  for (int i = 0; i < ABBE_VIEW_MOST_EVENTS; i++) {
    assert_true(abbe_view_events_take(&q, &e));
    assert_int_equal(e.down, i < ABBE_VIEW_MOST_EVENTS - 10);
  }
  assert_int_equal(q.count, 0);
}

/* Each is right but for one thing. */
TEST(lines_that_are_no_events_are_refused) {
  static const char *const lines[] = {
      "",          " \t\r",      "fly away",
      "move",      "move 1",     "move 1 x",
      "move 1 2y", "move 1 1e9", "size 5",
      "size 5 0",  "wheel",      "wheel 1e3",
      "down",      "down 3",     "up -1",
      "key",       "key s",      "key s apart",
      "key s",     "down x",     "key a-key-with-a-name-that-is-longer-than-all down"};
  for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
    char line[96];
    abbe_view_event e;
    snprintf(line, sizeof line, "%s", lines[i]);
    REFUSED(ABBE_PARSE, "' is no event", abbe_view_event_read(line, &e, &error));
  }
  const abbe_view_event e = event("key s down shift control words that nobody reads");
  assert_true(e.shift && e.control && e.down);
}

/* A turn of the wheel waits for the place it is at. */
TEST(a_wheel_elsewhere_is_another) {
  static const struct {
    const char *before, *then; /* what waits ahead of the wheel, and what comes behind it */
    size_t count;
  } cases[] = {{NULL, "move 5 5", 2},       {"down 0", "move 5 5", 3},
               {"move 5 5", "move 5 6", 3}, {"move 5 5", "move 6 5", 3},
               {"move 5 5", "move 5 5", 2}, {"move 5 5", "up 0", 3}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    static abbe_view_events q;
    q.first = q.count = 0;
    if (cases[i].before != NULL) add(&q, cases[i].before);
    add(&q, "wheel 1");
    add(&q, cases[i].then);
    assert_int_equal(q.count, cases[i].count);
  }
}
