/* The table of settings: names that cannot be mixed up, and limits that a request is held to. */
#include "tests/check.h"

#include "gl/plan/facts/render_settings.h"

TEST(keys_and_options_name_one_setting_each) {
  for (size_t i = 0; i < abbe_render_settings_count; i++) {
    const abbe_render_setting *a = &abbe_render_settings[i];
    assert_true(a->option == NULL || a->help != NULL);
    assert_true((a->kind == ABBE_SETTING_CHOICE) == (a->name_count > 0));
    for (size_t k = 0; k < i; k++) {
      const abbe_render_setting *b = &abbe_render_settings[k];
      assert_string_not_equal(a->key, b->key);
      assert_int_not_equal(a->offset, b->offset);
      if (a->option != NULL && b->option != NULL) assert_string_not_equal(a->option, b->option);
    }
  }
}

/* Each count alone, just beyond its most, in a request whose others are the defaults. */
TEST(a_request_is_held_to_every_limit) {
  size_t held = 0;
  for (size_t i = 0; i < abbe_render_settings_count; i++) {
    const abbe_render_setting *s = &abbe_render_settings[i];
    if (s->kind != ABBE_SETTING_COUNT || s->what == NULL) continue;
    abbe_render_desc desc = {0}, out;
    *(size_t *)abbe_render_setting_in(s, &desc) = (size_t)s->most + 1;
    REFUSED(ABBE_INVALID_ARGUMENT, s->what, abbe_render_desc_resolve(&desc, 8, 8, &out, &error));
    held++;
  }
  assert_int_equal(held, 18);
}
