/* cut_text.h: UTF-8 as the Windows-1252 of GemCad's files. Internal to scenes/. */
#ifndef ABBE_SCENES_CUTS_CUT_TEXT_H
#define ABBE_SCENES_CUTS_CUT_TEXT_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Writes at most size - 1 bytes and a zero; control characters become spaces, letters that the
 * encoding lacks '?'. Returns the bytes written. */
size_t abbe_cut_text_narrow(const char *utf8, char *out, size_t size);

#ifdef __cplusplus
}
#endif
#endif
