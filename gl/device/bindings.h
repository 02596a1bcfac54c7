/* bindings.h: where shaders find their buffers: one list, read by C and by GLSL. A number means one
 * buffer, in every program. Internal to gl/. */
#ifndef ABBE_GL_DEVICE_BINDINGS_H
#define ABBE_GL_DEVICE_BINDINGS_H

/* The scene: uniform blocks, or storage where a block is too small. */
#define BINDING_LIGHTS 0
#define BINDING_REFRACTORS 1
#define BINDING_PLANES 2
#define BINDING_RECEIVERS 3
#define BINDING_SURFACES 4
#define BINDING_SPECTRA 5
#define BINDING_BANDS 6
#define BINDING_SHADOW_PLANES 7

/* Photons: cells of the grid that may show a refractor, those of the coarser level, the photons
 * and which one each cell has. */
#define BINDING_CELLS 8
#define BINDING_COARSER_CELLS 9
#define BINDING_PHOTONS 10
#define BINDING_PHOTON_OF_CELL 11
#define BINDING_FOUND_BOX 12

/* Their hits: places, path signatures, which paths there are, what the ledger weighs them by. */
#define BINDING_HITS 13
#define BINDING_SIGNATURES 14
#define BINDING_PATH_MARKS 15
#define BINDING_PATHS 16
#define BINDING_SAMPLE_WEIGHTS 17
#define BINDING_LEDGER 18

/* Intervals between wavelengths that need all of theirs. */
#define BINDING_WANTS 19
#define BINDING_PAIRS 20

/* The spectral map. */
#define BINDING_SPLATS 21
#define BINDING_MAP_SUMS 22
#define BINDING_TEXEL_SIZES 23

/* The camera's picture: pixels that show a refractor, and those that need all bands. */
#define BINDING_PIXELS 24
#define BINDING_REFINED_PIXELS 25

/* Samples of receivers that take more rays. */
#define BINDING_ADAPTIVE_SAMPLES 27

/* Irradiance by normal of what an environment's lights leave of it. */
#define BINDING_SOFT_LIGHT 28

/* What receivers reflect of each light. */
#define BINDING_REFLECTIONS 29

/* Pixels of which some samples show a refractor. */
#define BINDING_MERGED_PIXELS 30

/* What the camera's rays through refractors show of receivers: the places, and where each pixel's
 * begin. */
#define BINDING_SIGHTS 31
#define BINDING_SIGHT_PIXELS 32

/* Texels of pinholes' tiles: those that are filled now, and those that need more samples. */
#define BINDING_PAGE_TEXELS 34
#define BINDING_UNFINISHED 33

/* What makes refractors glow: rays, and what each of their bands gives. */
#define BINDING_GLOW 35
#define BINDING_GLOW_SUMS 36

/* A list that becomes the size of a dispatch. */
#define BINDING_DISPATCH 26

#define BINDING_COUNT 37

/* Texture units that keep what they show; passes bind theirs below and say so. */
#define UNIT_BVH_NODES 7
#define UNIT_BVH_TRIANGLES 8
#define UNIT_BVH_CORNERS 9
#define UNIT_TILE_ROWS 10
#define UNIT_TILE_INDEX 11
#define UNIT_CHART_ROWS 12
#define UNIT_SIDE_OF_FACE 13
#define UNIT_WARPS 14
#define UNIT_ENVIRONMENT 15
#define UNIT_ENVIRONMENT_CUBE 16
#define UNIT_SHAFTS 17
#define UNIT_BAND_TEXELS 18
#define UNIT_SEEN_RECEIVERS 19
#define UNIT_FILMS 20
#define UNIT_GLOW 21

#endif
