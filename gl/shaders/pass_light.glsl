// The light that a pass is of, copied as the tables are (copies.glsl) by copy_light().
#include "light_number.glsl"

Light pass_light;

void copy_light() { pass_light = lights[light]; }
