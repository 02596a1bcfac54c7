/* cut_text.h: UTF-8 to and from the Windows-1252 of GemCad's files. Internal to scenes/. */
#ifndef ABBE_SCENES_CUTS_CUT_TEXT_H
#define ABBE_SCENES_CUTS_CUT_TEXT_H

#include <stddef.h>

/* Writes at most size - 1 bytes and a zero; control characters become spaces, letters that the
 * encoding lacks '?'. Returns the bytes written. */
size_t abbe_cut_text_narrow(const char *utf8, char *out, size_t size);

/* size bytes of Windows-1252 as UTF-8, malloc'd; control characters become spaces, bytes without a
 * meaning U+FFFD. NULL without memory. */
char *abbe_cut_text_widen(const char *bytes, size_t size);

#endif
