/* colour_map.h: numbers as colours, for false-colour pictures and their scale bars.
 *
 * Two maps: one for amounts, from black to white with lightness rising throughout, so that it also
 * reads in grey [Green2011]; one for differences about a middle, from blue over light grey to red
 * [Moreland2009]. It scales nothing: that is the caller's axis. */
#ifndef ABBE_COLORIMETRY_IMAGE_COLOUR_MAP_H
#define ABBE_COLORIMETRY_IMAGE_COLOUR_MAP_H

typedef enum abbe_colour_map {
  ABBE_COLOUR_MAP_AMOUNT,    /* 0 black, 1 white */
  ABBE_COLOUR_MAP_DIFFERENCE /* 0 blue, 0.5 light grey, 1 red */
} abbe_colour_map;

/* The sRGB-encoded colour of t, components in [0, 1]. t is held in [0, 1]; NaN is a flat green that
 * neither map has. */
void abbe_colour_map_at(abbe_colour_map map, double t, double rgb[3]);

#endif
