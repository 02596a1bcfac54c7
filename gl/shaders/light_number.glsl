// The light that a pass is of. Of one light it is known to the compiler.
#if LIGHTS == 1
const int light = 0;
#else
uniform int light;
#endif
