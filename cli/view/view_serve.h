/* view_serve.h: the viewer as a page for a browser, for those who work on a server: the window that
 * nobody sees, over HTTP on the loopback, for who has the token. Internal to cli/view/. */
#ifndef ABBE_CLI_VIEW_VIEW_SERVE_H
#define ABBE_CLI_VIEW_VIEW_SERVE_H

#include "cli/view/view_app.h"

/* Prints the address with its token on standard output and serves until SIGINT, SIGTERM or SIGHUP
 * come. port 0: any free one. ABBE_UNSUPPORTED in a build without libmicrohttpd, ABBE_IO where the
 * port is taken; errors of abbe_view_hidden_begin.
 *
 *   GET  /?token=T                    the page
 *   GET  /picture?token=T&after=N     the window as PNG, its number in X-Abbe-Frame; 204 where none
 *                                     later than N has come within a second
 *   POST /events?token=T              lines, at most 64 KiB: move X Y; down B [shift] [control]; up
 *                                     B; wheel CLICKS; key NAME down|up [shift] [control]; size W H
 *
 * Moves that follow each other are one, and sizes; turns of the wheel are added up. Signals are
 * obeyed within a second whatever waits. 403 without the token, with a Host that is not this
 * machine's or an Origin that is not this page's; the connection ends then. 404 and 405 elsewhere,
 * 400 with the line that is wrong, 413, and 503 while too many events wait. */
abbe_result abbe_view_serve_run(unsigned port, const abbe_view_app_desc *desc, size_t width,
                                size_t height, abbe_error *error);

#endif
