/* exr_parts.h: what reading and writing OpenEXR files share, and which part of a file is read.
 * Internal to colorimetry/. */
#ifndef ABBE_COLORIMETRY_IMAGE_EXR_PARTS_H
#define ABBE_COLORIMETRY_IMAGE_EXR_PARTS_H

#include "colorimetry/image/image.h"

#include <openexr.h>
#include <stdbool.h>

/* The texts that are the file's own: whether it is in scan lines or tiles, and what a stored 1
 * stands for. */
#define ABBE_EXR_STORAGE_NAME "type"
#define ABBE_EXR_UNIT_NAME "abbe:stored_unit"

/* What the numbers of R, G and B are, and "data" of a part that has no colours. */
#define ABBE_EXR_ID_NAME "colorInteropID"

/* What a context reads from, and the first thing that the library complained of. */
typedef struct abbe_exr_stream {
  const char *path; /* as given, also of one part */
  const char *part; /* its name or number, as given; NULL: that which has the picture */
  int fd;
  int64_t size;
  int io_errno; /* error of a failed system call; 0: the bytes themselves are at fault */
  bool failed;  /* some read has */
  char message[512];
} abbe_exr_stream;

/* Layout of the part that is read. */
typedef struct abbe_exr_layout {
  int part, parts;
  const char *name; /* the part's name; NULL: it has none */
  exr_storage_t storage;
  exr_compression_t compression;
  exr_attr_box2i_t data, display; /* the windows */
  const exr_attr_chlist_t *channels;
} abbe_exr_layout;

/* A part whose chunks are read into the picture's channels from `first` on; by one thread. Freed by
 * abbe_exr_source_free. */
typedef struct abbe_exr_source {
  abbe_exr_layout layout;
  double unit;
  int first;
  exr_decode_pipeline_t pipe;
  exr_result_t (*decompress)(exr_decode_pipeline_t *pipe); /* the library's; NULL: nothing packs */
  void *inflater;
  uint8_t *differences; /* [bytes] what ZIP packs */
  size_t bytes;
} abbe_exr_source;

/* Three sums of channels in the place of a picture's channels, and behind them those channels. */
typedef struct abbe_exr_sums {
  const double *weight[ABBE_IMAGE_MAX_CHANNELS]; /* [3] of each; NULL: it does not count */
  size_t place[ABBE_IMAGE_MAX_CHANNELS];         /* the picture's channel; 0: it is not kept */
  double factor[ABBE_IMAGE_MAX_CHANNELS];        /* of what is kept */
  abbe_image_odd odd;                            /* of those that count; threads add to it */
} abbe_exr_sums;

/* Where a chunk that is decoded goes: its first sample belongs to the picture's pixel (x, y), which
 * may lie outside. */
typedef struct abbe_exr_place {
  abbe_exr_source *part;
  const abbe_image *image; /* where there are sums, its first three channels are added to */
  abbe_exr_sums *sums;     /* NULL: the channels themselves */
  int64_t x, y;
} abbe_exr_place;

/* Decodes one chunk of at most width x height pixels to `at`, whose part is filled in. */
exr_result_t abbe_exr_source_read(exr_context_t context, abbe_exr_source *from,
                                  const exr_chunk_info_t *chunk, int64_t width, int64_t height,
                                  const abbe_exr_place *at);
void abbe_exr_source_free(exr_context_t context, abbe_exr_source *source);

/* Has the library allocate so that a thread knows whether it lacked memory: it does not always
 * tell, and goes on with other pixels. Asking forgets. */
void abbe_exr_allocate_by(exr_context_initializer_t *setup);
bool abbe_exr_starved(void);

int64_t abbe_exr_width(exr_attr_box2i_t window);
int64_t abbe_exr_height(exr_attr_box2i_t window);

/* What the library refuses, with its own words. */
abbe_result abbe_exr_fail(const abbe_exr_stream *s, exr_result_t rv, abbe_error *error);

/* The same of a file that it does not open: a codec that is too young for it is named. */
abbe_result abbe_exr_fail_open(const abbe_exr_stream *s, exr_result_t rv, abbe_error *error);

/* Finds the part, and checks that it can be read and held. ABBE_NOT_FOUND for a part that is not
 * there; else as abbe_exr_read. */
abbe_result abbe_exr_layout_find(exr_context_t context, const abbe_exr_stream *s,
                                 abbe_exr_layout *out, abbe_error *error);

/* Whether the part can be read and held, of a file of which so many channels are read. Errors of
 * abbe_exr_read. */
abbe_result abbe_exr_check_layout(const abbe_exr_stream *s, const abbe_exr_layout *l, int channels,
                                  abbe_error *error);

/* The first part besides that is marked as data, of the same windows in the same chunks and with
 * channels of other names: what is no colour of the same picture. *parts becomes 2 where there is
 * one. */
abbe_result abbe_exr_find_data(exr_context_t context, const abbe_exr_stream *s,
                               const abbe_exr_layout *picture, abbe_exr_layout *out, size_t *parts,
                               abbe_error *error);

/* Chromaticities and texts of a part's header, and the wavelengths that channels are called by.
 * ABBE_PARSE for a wavelength that is none, ABBE_UNSUPPORTED for too many texts. */
abbe_result abbe_exr_attributes_read(exr_context_t context, int part, const abbe_exr_stream *s,
                                     abbe_image *image, abbe_error *error);

/* What a stored 1 of the part stands for. ABBE_PARSE for a unit that is none. */
abbe_result abbe_exr_unit_read(exr_context_t context, int part, const abbe_exr_stream *s,
                               double *unit, abbe_error *error);

#endif
