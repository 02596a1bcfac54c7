// The coarse set of wavelengths: node k of those that every photon takes, among all of them.
int coarse_node(int k) { return (k * (counts.wavelengths - 1) + (counts.nodes - 1) / 2) / max(counts.nodes - 1, 1); }
