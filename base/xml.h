/* xml.h: where expat reads. */
#ifndef ABBE_BASE_XML_H
#define ABBE_BASE_XML_H

#include <expat.h>

#include <stddef.h>

/* The line of the element that is reported, from 1; expat 2.9 has a function of its own for it. */
static inline size_t abbe_xml_line(XML_Parser parser) {
#if XML_MAJOR_VERSION > 2 || XML_MINOR_VERSION >= 9
  return (size_t)XML_GetCurrentLineNumber64(parser);
#else
  return (size_t)XML_GetCurrentLineNumber(parser);
#endif
}

#endif
