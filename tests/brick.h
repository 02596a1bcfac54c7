#ifndef ABBE_TESTS_BRICK_H
#define ABBE_TESTS_BRICK_H

/* A lamp, a brick of crown and a floor: the least scene of which a caustic can be computed. */
static const char brick_scene[] =
    "materials: table.yaml\n"
    "camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05], size: [3, 2]}\n"
    "lights:\n- {name: lamp, kind: point, position: [0.05, 0.03, 0.6], intensity: 1}\n"
    "objects:\n- {name: floor, shape: rectangle, width: 2, height: 2, reflectance: 0.5}\n"
    "- {name: brick, shape: box, size: [0.1, 0.08, 0.06], transform: [{translate: [0, 0, 0.2]}],\n"
    "   material: crown}\n";

#endif
