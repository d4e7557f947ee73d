// Lines of samples that lie in a texture of their own (shared/gathered.glsl): each looks its tile up.
//
// UNION, TRANSLUCENT, JOINED, STYLED, SIDES, LIMITS, LENS   as in bins.frag.glsl
#define GATHERED 1
#include "technique/dynamic_lines/bins.frag.glsl"
