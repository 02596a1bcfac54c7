#include "scenes/cuts/cut.h"

#include "tests/check.h"

TEST(letters_of_windows_1252_become_a_byte_each) {
  char out[32];
  assert_int_equal(abbe_cut_text_narrow("a\xc3\xa9\xe2\x82\xac\xc2\xb0", out, sizeof out), 4);
  assert_string_equal(out, "a\xe9\x80\xb0");
  assert_int_equal(abbe_cut_text_narrow("\xe2\x88\x92\n\x7f", out, sizeof out), 3);
  assert_string_equal(out, "?  ");
  assert_int_equal(abbe_cut_text_narrow("\xff", out, sizeof out), 1);
  assert_string_equal(out, "?");
  assert_int_equal(abbe_cut_text_narrow("abcdef", out, 4), 3);
  assert_string_equal(out, "abc");
}

TEST(bytes_come_back_as_letters) {
  char bytes[256], back[256];
  for (int i = 0; i < 255; i++) bytes[i] = (char)(i + 1);
  FREED char *text = abbe_cut_text_widen(bytes, 255);
  assert_int_equal(abbe_cut_text_narrow(text, back, sizeof back), 255);
  for (int i = 0; i < 255; i++) {
    const unsigned char byte = (unsigned char)bytes[i];
    const bool none = byte == 0x81 || byte == 0x8d || byte == 0x8f || byte == 0x90 || byte == 0x9d;
    const bool control = byte < ' ' || byte == 0x7f;
    assert_int_equal((unsigned char)back[i], none ? '?' : control ? ' ' : byte);
  }
}
