/* inspect.h: pictures of any program as a window shows them: which numbers, how they look, and what
 * a pixel or a region has.
 *
 * It knows no window and draws nothing. Pictures are read once and stay as they are. Of large ones
 * whose file has levels of detail a coarse level is read, and of finer ones what is shown when it
 * is; of large ones in scan lines some lines are read first. What is shown is converted tile by
 * tile, at about the screen's resolution, and kept until the look changes. Internal to cli/view/.
 */
#ifndef ABBE_CLI_VIEW_INSPECT_INSPECT_H
#define ABBE_CLI_VIEW_INSPECT_INSPECT_H

#include "colorimetry/image/display_ocio.h"
#include "colorimetry/image/exr.h"
#include "colorimetry/image/picture_space.h"
#include "colorimetry/plot/chart.h"
#include "colorimetry/spectral_picture/spectral_channels.h"

enum {
  ABBE_INSPECT_MOST_PICTURES = 16,
  ABBE_INSPECT_LEVELS = 16,
  ABBE_INSPECT_CLOUD = 400,
  ABBE_INSPECT_BINS = 64
};

/* What can be shown of a picture. */
typedef enum abbe_inspect_kind {
  ABBE_INSPECT_COLOUR,   /* R, G, B or X, Y, Z, of a layer too */
  ABBE_INSPECT_SPECTRUM, /* the colour of its bands */
  ABBE_INSPECT_BAND,     /* the band nearest to the look's wavelength */
  ABBE_INSPECT_DEGREE,   /* of that band: the degree of polarisation, by S0 to S3 */
  ABBE_INSPECT_ANGLE,    /* and the angle of linear polarisation, degrees, -90 to 90 */
  ABBE_INSPECT_CHANNEL
} abbe_inspect_kind;

typedef struct abbe_inspect_entry {
  abbe_inspect_kind kind;
  size_t channel[3]; /* of a colour; of a channel the first */
} abbe_inspect_entry;

/* How pictures look. Zeroed: their first entry, as the observer of 1931 sees it. */
typedef struct abbe_inspect_look {
  const abbe_display *display; /* of ACEScg */
  size_t entry;
  bool false_colours; /* of what is no colour */
  bool difference;    /* less the other picture: Y of colours */
  double exposure;    /* stops */
  double wavelength_nm;
  abbe_spectral_view view; /* view.to counts where the light is known, and of reflectances */
} abbe_inspect_look;

/* Weights of channels that make what is shown: ACEScg, or one number three times. */
typedef struct abbe_inspect_mix {
  abbe_inspect_kind kind;
  size_t count;
  size_t *channel;
  double (*weight)[3];
  double unit; /* XYZ of this mix times it is in the picture's unit (lm; cd/m2 of a radiance) */
} abbe_inspect_mix;

/* Part of a picture at one scale: across x down tiles of 64 x 64 pixels, four bytes each. */
typedef struct abbe_inspect_level {
  size_t across, down;
  unsigned char **tile; /* NULL: not made */
} abbe_inspect_level;

typedef struct abbe_inspect_picture {
  const char *path;
  char *own;               /* the path, where it is the picture's; or NULL */
  size_t serial;           /* of no other picture */
  bool sent;               /* it is no file: another program sends it */
  bool changed;            /* since it was shown */
  size_t width, height;    /* of the picture; */
  size_t coarse;           /* level of it that is in memory, of half the side each; 0: all of it */
  abbe_image image;        /* that level */
  abbe_exr_reader *reader; /* of what is not in memory yet; NULL: all that is shown is */
  double read;             /* share of its scan lines that are; the others are as those above */
  abbe_spectral_channels bands;
  abbe_picture_space space;
  char note[1024]; /* why its R, G, B, or its bands, are no colour; else "" */
  bool renamed;    /* its bands are called w420nm and the like: light in an unknown unit */
  bool encoded;    /* a PNG, whose light is 0 to 1 */
  size_t count;    /* of entries: */
  abbe_inspect_entry *entry;
  const char **name; /* [count] texts of entries; those of channels are the image's */
  abbe_image_odd odd;
  size_t odd_at[2];       /* the first odd pixel, in the picture */
  double most;            /* greatest finite magnitude */
  abbe_inspect_look look; /* that the tiles have, of a difference from this picture: */
  size_t other;
  abbe_inspect_mix mix, minus;    /* what is shown, less that of the other in a difference */
  abbe_chart_field scale;         /* of what is no colour, and of differences: min, max, map */
  double least_shown, most_shown; /* of the samples */
  double stops;                   /* by which a tenth of them would be above 0.8; 0: not known */
  size_t
      bin[ABBE_INSPECT_BINS]; /* histogram: of Y in stops from 0.18, -10 to 6, or of min to max */
  abbe_inspect_level level[ABBE_INSPECT_LEVELS];
} abbe_inspect_picture;

/* Numbers of a large picture that are in memory first: 64 MiB. */
#define ABBE_INSPECT_MOST_NUMBERS ((size_t)1 << 24)

typedef struct abbe_inspect {
  size_t most_numbers;     /* 0: as above */
  size_t made;             /* pictures in all, also those that are closed */
  size_t count, at, other; /* pictures; the one that is shown; the one beside it */
  abbe_inspect_picture picture[ABBE_INSPECT_MOST_PICTURES];
  abbe_inspect_look look;
  double centre[2]; /* pixel of the image in the middle */
  double zoom;      /* pixels of the screen for one of the image */
} abbe_inspect;

/* Reads a picture behind the others. Errors of abbe_picture_file_read, abbe_png_read,
 * abbe_avif_read and abbe_spectral_channels_find; ABBE_UNSUPPORTED for other kinds,
 * ABBE_OUT_OF_RANGE for one picture too many. */
abbe_result abbe_inspect_open(abbe_inspect *inspect, const char *path, abbe_error *error);
/* Reads for so many seconds what large pictures lack; *whole: they lack nothing. Errors of
 * abbe_exr_read; that picture stays as it is then. */
abbe_result abbe_inspect_read_on(abbe_inspect *inspect, double seconds, bool *whole,
                                 abbe_error *error);
/* Makes a black one of size: width, height and channels, behind the others. Errors of
 * abbe_image_make and abbe_spectral_channels_find; ABBE_OUT_OF_RANGE as above. */
abbe_result abbe_inspect_create(abbe_inspect *inspect, const char *name, const size_t size[3],
                                const char *const *channel, abbe_error *error);
/* Takes a picture out; those behind it move up. Where it was shown, another one is to be, and no
 * difference where it was taken off another. */
void abbe_inspect_close(abbe_inspect *inspect, size_t at);
/* The last picture takes the place of another, which is closed. */
void abbe_inspect_replace(abbe_inspect *inspect, size_t at);
/* One that says that nothing has been sent stands where there is none, until there is. */
abbe_result abbe_inspect_await(abbe_inspect *inspect, abbe_error *error);
void abbe_inspect_free(abbe_inspect *inspect);

/* Does what a packet of tev's protocol [Tev] says, whose first four bytes are its length: opens,
 * reads again, creates, updates or closes a picture; *focus becomes which one is to be shown, if it
 * says so. NULL for inspect: it is only checked, and focus may be NULL. ABBE_PARSE for what is no
 * packet. Of one that is: errors of abbe_inspect_open and abbe_inspect_create, ABBE_NOT_FOUND for a
 * picture or a channel that is not there, ABBE_OUT_OF_RANGE for pixels that are not and for created
 * pictures of more than 1 GiB together, ABBE_UNSUPPORTED for drawings. */
abbe_result abbe_inspect_take_packet(abbe_inspect *inspect, const unsigned char *bytes, size_t size,
                                     size_t *focus, abbe_error *error);

/* Shows picture `at` with that look, whose entry is one of the picture that was shown: of another
 * picture that of the same name, or its first one. Nothing is converted yet; tiles that are there
 * stay where the look is the same. Errors of abbe_spectral_colour_weights; ABBE_INVALID_ARGUMENT
 * for a difference of pictures at different places, ABBE_NOT_FOUND of entries that the other does
 * not have. What was shown stays then. */
abbe_result abbe_inspect_show(abbe_inspect *inspect, size_t at, const abbe_inspect_look *look,
                              abbe_error *error);

/* The whole picture into so many pixels of the screen. */
void abbe_inspect_fit(abbe_inspect *inspect, size_t width, size_t height);
/* Nearer by so many clicks of a wheel, from the whole picture or 16 pixels of its larger side on;
 * what is under that place of the screen stays there. */
void abbe_inspect_wheel(abbe_inspect *inspect, const size_t size[2], const double place[2],
                        double clicks);
/* The pixel of the image under a place of the screen; false: beside it. */
bool abbe_inspect_pixel(const abbe_inspect *inspect, const size_t size[2], const double place[2],
                        size_t pixel[2]);

/* A screen of width x height pixels, four bytes each, rows downward. Tiles that it lacks are made
 * for so many seconds, one at least; what is not there yet is dark or coarse. *whole: nothing is
 * missing. A tile's pixel is the mean of those of the image that it covers, of at most 4 x 4.
 * Errors of abbe_display_apply. */
abbe_result abbe_inspect_draw(abbe_inspect *inspect, size_t width, size_t height, double seconds,
                              unsigned char *out, bool *whole, abbe_error *error);

/* What a picture has in a region, of its channels one by one: mean, standard deviation and standard
 * error of the mean, as of independent pixels; of one pixel, the error that the file states. NaN
 * stands for what is not known. What is not finite is left out channel by channel, and of the
 * colour the pixels where one of its channels is not. */
typedef struct abbe_inspect_probe {
  size_t window[4];   /* x0, y0, x1, y1 in the picture, both ends included */
  size_t side;        /* more than 1: its pixels are means of so many a side */
  size_t pixels, odd; /* odd: those where what is shown is not finite */
  size_t channels;
  double *mean, *deviation, *error; /* [channels] */
  bool coloured;                    /* of what is shown if it is a colour, else of the bands, else
                                       of R, G, B: */
  double xyz[3], xy[2], uv[2];
  double unit; /* xyz times it is in lm (of a radiance: cd/m2); 0: in the picture's own */
  double dominant_nm, purity; /* with respect to D65; NaN: none */
  size_t cloud_count;
  double cloud[ABBE_INSPECT_CLOUD][2]; /* x, y of pixels of the region, evenly taken */
} abbe_inspect_probe;

/* ABBE_NO_MEMORY; errors of abbe_spectral_colour_weights. */
abbe_result abbe_inspect_probe_make(const abbe_inspect *inspect, size_t at, const size_t window[4],
                                    abbe_inspect_probe *out, abbe_error *error);
void abbe_inspect_probe_free(abbe_inspect_probe *probe);

/* Between the sources: pixels of a picture that are in memory, those of a level from one on; the
 * weights of an entry, and what they make of a pixel. */
typedef struct abbe_inspect_source {
  const abbe_image *image; /* the picture's, or own */
  abbe_image own;
  size_t level, x0, y0;
} abbe_inspect_source;
/* Those of a window of the picture, at that level or the next coarser one that there is; what is
 * not in memory is read. Errors of abbe_exr_read_level. */
abbe_result abbe_inspect_source_take(const abbe_inspect_picture *picture, size_t level,
                                     const size_t window[4], abbe_inspect_source *out,
                                     abbe_error *error);
/* The channels of a pixel of the picture, which lies in the window. */
const float *abbe_inspect_source_pixel(const abbe_inspect_source *source, size_t x, size_t y);
abbe_result abbe_inspect_mix_make(const abbe_inspect_picture *picture,
                                  const abbe_inspect_entry *entry, const abbe_inspect_look *look,
                                  abbe_inspect_mix *out, abbe_error *error);
void abbe_inspect_mix_free(abbe_inspect_mix *mix);
void abbe_inspect_mix_at(const abbe_inspect_mix *mix, const abbe_inspect_picture *picture,
                         const float *pixel, double out[3]);
bool abbe_inspect_is_colour(abbe_inspect_kind kind);
void abbe_inspect_tiles_free(abbe_inspect_picture *picture);
/* Pixels of a picture in that window have changed: what is shown of them is made anew. */
void abbe_inspect_touch(abbe_inspect *inspect, size_t at, const size_t window[4]);

#endif
