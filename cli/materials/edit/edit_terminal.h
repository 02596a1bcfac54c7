/* edit_terminal.h: takes the terminal for a full screen, and gives it back on every way out. */
#ifndef ABBE_CLI_MATERIALS_EDIT_EDIT_TERMINAL_H
#define ABBE_CLI_MATERIALS_EDIT_EDIT_TERMINAL_H

#include <stdbool.h>

/* Takes standard input and output; false where they are no terminal that curses can draw on. */
bool abbe_edit_terminal_take(void);
void abbe_edit_terminal_give_back(void);
/* Whether a signal asked for the end, or the terminal has hung up. */
bool abbe_edit_terminal_ended(void);
/* Whether its characters are UTF-8. */
bool abbe_edit_terminal_is_utf8(void);

#endif
