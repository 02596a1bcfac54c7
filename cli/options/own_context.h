/* own_context.h: the context that a command draws with, and a word where a GPU that is there is not
 * taken for it. Internal to cli/.
 */
#ifndef ABBE_CLI_OPTIONS_OWN_CONTEXT_H
#define ABBE_CLI_OPTIONS_OWN_CONTEXT_H

#include "gl/device/context.h"

/* abbe_context_make. Where AUTO finds a GPU that does not suffice, a note on stderr says why, in
 * one line, once in a process and not at all where it is to be quiet. Any thread may call it. */
abbe_result abbe_own_context_make(abbe_context_backend backend, bool quiet, abbe_context **out,
                                  abbe_error *error);

#endif
