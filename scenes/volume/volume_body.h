/* volume_body.h: the shape that a caustic volume belongs to, as far as it takes to find out whether
 * an object has it, and how the object is turned and where it stands.
 */
#ifndef ABBE_SCENES_VOLUME_VOLUME_BODY_H
#define ABBE_SCENES_VOLUME_VOLUME_BODY_H

#include "scenes/scene.h"

typedef struct abbe_volume_body {
  char name[128], material[128]; /* the object's; what it is made of */
  bool ball;                     /* looks the same from all sides */
  double radius;                 /* radius of what bounds it around its centre, m */
  size_t vertices, faces;
  size_t anchor[3];       /* vertices that fix how it is turned; not read of a ball */
  double anchor_at[3][3]; /* from its centre, m */
} abbe_volume_body;

/* Where an object with that shape is: world = centre + turn * body. */
typedef struct abbe_volume_place {
  double centre[3];
  double turn[9]; /* row-major rotation */
} abbe_volume_place;

/* ABBE_INVALID_ARGUMENT for a receiver, and for a shape that is flat. */
abbe_result abbe_volume_body_make(const abbe_object *object, abbe_volume_body *out,
                                  abbe_error *error);

/* ABBE_UNSUPPORTED, with what differs, where the object is of another shape, size or material. */
abbe_result abbe_volume_body_find(const abbe_volume_body *body, const abbe_object *object,
                                  abbe_volume_place *out, abbe_error *error);

#endif
