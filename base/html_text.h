/* html_text.h: the plain text of a scrap of HTML, as references in databases are written.
 *
 * Tags go, the common entities become their letters, and runs of blanks become one. It is no parser
 * of pages: scripts and styles are text to it.
 */
#ifndef ABBE_BASE_HTML_TEXT_H
#define ABBE_BASE_HTML_TEXT_H

#include <stddef.h>

/* The text of html in UTF-8, malloc'd, at most max bytes and cut between letters; NULL where there
 * is no memory. A '<' that begins no tag stays. */
char *abbe_html_text(const char *html, size_t max);
/* Its inverse: '&', '<' and '>' as entities; malloc'd, NULL where there is no memory. */
char *abbe_html_escape(const char *text);

#endif
