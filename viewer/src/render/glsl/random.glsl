// Two points of a two-dimensional additive recurrence in 32-bit integers: x_i = i (1/g, 1/g^2) mod 1 with g^3 = g + 1
// (M. Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018), each coordinate shifted by a hash of the
// pixel. They are for two strategies whose samples are added, so that each may be even without the other. Integers wrap
// exactly; a float32 product loses the fraction after some thousand points.

const uint STEPS[4] = uint[4](@STEPS@);

uint hash(uint x) {
  // PCG output permutation: M. Jarzynski, M. Olano, "Hash Functions for GPU Rendering", JCGT 9(3), 2020.
  uint state = x * 747796405u + 2891336453u;
  uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
  return (word >> 22u) ^ word;
}

float random(uint i, int dimension, uint pixel) {
  uint shift = hash(pixel * 4u + uint(dimension));
  return float((i * STEPS[dimension] + shift) >> 8u) * (1.0 / 16777216.0);
}
