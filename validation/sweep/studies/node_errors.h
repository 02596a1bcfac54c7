/* node_errors.h: how far what looks a caustic up at light nodes is from photons with the light at a
 * node, where nothing lies between, and in the middle of three, where most does.
 * Internal to validation/sweep/studies/.
 */
#ifndef ABBE_VALIDATION_SWEEP_STUDIES_NODE_ERRORS_H
#define ABBE_VALIDATION_SWEEP_STUDIES_NODE_ERRORS_H

#include "gl/renderer.h"
#include "scenes/volume/light_nodes.h"
#include "validation/sweep/sweep_measure.h"

#define ABBE_NODE_ERRORS_PLACES                                                                    \
  3                             /* places of each kind, those nearest to the scene's first light */
#define ABBE_NODE_ERRORS_SETS 8 /* sets of nodes */

/* Places of the light: first at nodes, then between them. */
#define ABBE_NODE_ERRORS_ALL (2 * ABBE_NODE_ERRORS_PLACES)

/* What photons show by default with the light there. A zeroed one knows nothing yet. */
typedef struct abbe_node_errors {
  size_t count;
  struct {
    size_t nodes;
    abbe_image truth[ABBE_NODE_ERRORS_ALL];
  } set[ABBE_NODE_ERRORS_SETS];
} abbe_node_errors;
void abbe_node_errors_free(abbe_node_errors *known);

/* Unit directions to the light: the nodes that are nearest to one, the nearest first, and the
 * middles of the triangles whose middles are. False of fewer than 12 nodes. */
bool abbe_node_errors_places(const abbe_light_nodes *nodes, const double to_light[3],
                             double place[ABBE_NODE_ERRORS_ALL][3]);

/* A light as it stands in that direction from `middle`, as far away as it is. False but of points
 * and directional lights. */
bool abbe_node_errors_move(const abbe_light *light, const double middle[3],
                           const double to_light[3], abbe_light *out);

/* The worst caustic_rmse of the renderer, of that request and the sweep's scene, at such nodes and
 * between them; NaN where there are no such places, or no caustic. Photons' pictures are drawn
 * where they are not known. The renderer is left as it was. Errors of abbe_renderer_change, _frame
 * and abbe_compare. */
abbe_result abbe_node_errors_measure(abbe_node_errors *known, const abbe_sweep *sweep,
                                     const abbe_light_nodes *nodes, const abbe_render_desc *desc,
                                     abbe_renderer *renderer, double *at_node, double *between,
                                     abbe_error *error);

#endif
