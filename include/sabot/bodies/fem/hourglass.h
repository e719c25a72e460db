#ifndef sabot_bodies_fem_hourglass_h
#define sabot_bodies_fem_hourglass_h

namespace sabot
{
/**
 * Sums over the corners of a hexahedron with the base vectors that are
 * orthogonal to constants (Flanagan & Belytschko 1981), corner order of VTK:
 * the three linear ones,
 *
 *   l_1 = (-++-, -++-), l_2 = (--++, --++), l_3 = (----, ++++),
 *
 * and the four of hourglass modes, which a parallelepiped does not have,
 *
 *   h_1 = (++--, --++), h_2 = (+--+, -++-), h_3 = (+-+-, +-+-),
 *   h_4 = (-+-+, +-+-):
 *
 *   linear_k = sum_a l_ka x_a,  mode_m = sum_a h_ma x_a,
 *
 * by sums and differences along one edge after the other, 23 additions for all
 * seven. In the unit of x, of entries 1 (|l|^2 = |h|^2 = 8). @p Value: double,
 * Vec or Pack.
 *
 * A translation has neither; rotations of a parallelepiped have no modes. What
 * a linear field gives a cell that is no parallelepiped is taken off by the
 * form: gamma_a = h_a - sum_b (h_b X_b) . B_a.
 */
template <typename Value>
inline void corner_sums(const Value x[8], Value linear[3], Value mode[4])
{
  // Along the first edges: differences and sums of the ends.
  const Value d0 = x[1] - x[0], d1 = x[2] - x[3], d2 = x[5] - x[4],
              d3 = x[6] - x[7];
  const Value s0 = x[0] + x[1], s1 = x[3] + x[2], s2 = x[4] + x[5],
              s3 = x[7] + x[6];
  // Along the second ones, below and above.
  const Value along_0 = d0 + d1, along_1 = d2 + d3;
  const Value twist_0 = d1 - d0, twist_1 = d3 - d2;
  const Value across_0 = s1 - s0, across_1 = s3 - s2;
  linear[0] = along_0 + along_1;
  linear[1] = across_0 + across_1;
  linear[2] = (s2 + s3) - (s0 + s1);
  mode[0] = across_1 - across_0;
  mode[1] = along_1 - along_0;
  mode[2] = twist_0 + twist_1;
  mode[3] = twist_1 - twist_0;
}

/** Back: f_a = sum_k l_ka linear_k + sum_m h_ma mode_m for the eight corners,
    the transpose of corner_sums(): sum_a f_a . x_a = sum_k linear_k . (linear
    sums of x)_k + sum_m mode_m . (modes of x)_m. f in the unit of linear and
    mode, overwritten. */
template <typename Value>
inline void corner_spread(const Value linear[3], const Value mode[4],
                          Value f[8])
{
  const Value along_0 = linear[0] - mode[1], along_1 = linear[0] + mode[1];
  const Value twist_0 = mode[2] - mode[3], twist_1 = mode[2] + mode[3];
  const Value across_0 = linear[1] - mode[0], across_1 = linear[1] + mode[0];
  const Value d0 = along_0 - twist_0, d1 = along_0 + twist_0,
              d2 = along_1 - twist_1, d3 = along_1 + twist_1;
  const Value s1 = across_0 - linear[2], s0 = -(across_0 + linear[2]),
              s3 = across_1 + linear[2], s2 = linear[2] - across_1;
  f[0] = s0 - d0;
  f[1] = s0 + d0;
  f[2] = s1 + d1;
  f[3] = s1 - d1;
  f[4] = s2 - d2;
  f[5] = s2 + d2;
  f[6] = s3 + d3;
  f[7] = s3 - d3;
}
} // namespace sabot

#endif
