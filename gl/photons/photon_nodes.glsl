// The coarse set of wavelengths: node k of the NODES that every photon takes, among all of them.
int coarse_node(int k) { return (k * (WAVELENGTHS - 1) + (NODES - 1) / 2) / max(NODES - 1, 1); }
