// What the camera's rays through refractors show of receivers, as places on parallelograms and weights: it
// stays as it is while the camera, the refractors and the receivers do, whatever lights do. Those of a
// thread are a chain.

// Words: place as off_anchor() says; weight of X, Y and Z; the chain's next one + 1, with the sheet above it; and the band
// that shows it + 1 (camera_bands.glsl), 0: all.
const uint SIGHT = 7u;
const uint SIGHT_NEXT = 0xffffffu;
// Words of a pixel: XYZ of what is no receiver, and its distance; XYZ of the share that is mirrored
// at the front, and the chain of what that shows; a chain of each thread.
const uint SIGHT_WORDS = 8u + uint(PIXEL_THREADS);

layout(std430, binding = BINDING_SIGHTS) SIGHTS_ACCESS buffer Sights {
  uint sight_count, sight_groups[3];
  uint sights[];
};
layout(std430, binding = BINDING_SIGHT_PIXELS) SIGHTS_ACCESS buffer SightPixels { uint sight_pixels[]; };

#ifdef KEEPS_SIGHTS
uniform uint sight_room;

uint sight_chain;    // the last of this thread + 1
vec3 sight_tail;    // what a path has left shows what the rest of it has shown: so many times that
bool sight_waits;    // seen() has found a receiver: there
int waiting_sheet;
vec2 waiting_place;

// weight: of X, Y and Z; of a band of all sets', -1: of all.
void note_sight(vec3 weight, int band) {
  uint i = atomicAdd(sight_count, 1u);
  if (i >= sight_room) return;
  uint word = SIGHT * i;
  sights[word] = floatBitsToUint(waiting_place.x);
  sights[word + 1u] = floatBitsToUint(waiting_place.y);
  for (int k = 0; k < 3; k++) sights[word + 2u + uint(k)] = floatBitsToUint(weight[k]);
  sights[word + 5u] = sight_chain | uint(waiting_sheet) << 24;
  sights[word + 6u] = uint(band + 1);
  sight_chain = i + 1u;
}

// Those that were noted after `from`.
void weigh_sights(uint from, vec3 factor) {
  uint i = sight_chain;
  while (i != from) {
    uint word = SIGHT * (i - 1u);
    for (int k = 0; k < 3; k++)
      sights[word + 2u + uint(k)] = floatBitsToUint(uintBitsToFloat(sights[word + 2u + uint(k)]) * factor[k]);
    i = sights[word + 5u] & SIGHT_NEXT;
  }
}
#endif
