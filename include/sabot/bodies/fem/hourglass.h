#ifndef sabot_bodies_fem_hourglass_h
#define sabot_bodies_fem_hourglass_h

namespace sabot
{
/**
 * mode_m = sum_a h_ma x_a with the four hourglass base vectors, which are
 * orthogonal to each other, to constants and to the linear fields of a
 * parallelepiped (Flanagan & Belytschko 1981), corner order of VTK:
 *
 *   h_1 = (++--, --++), h_2 = (+--+, -++-), h_3 = (+-+-, +-+-),
 *   h_4 = (-+-+, +-+-),
 *
 * by sums and differences of pairs: 20 additions instead of 28. In the unit of
 * x, of entries 1 in h (|h|^2 = 8). @p Value: double, Vec or Pack.
 *
 * The full sum of the rows of h is zero, so a translation has no modes;
 * rotations of a parallelepiped have none either. What a linear field gives a
 * cell that is no parallelepiped is taken off by the form: gamma_a = h_a -
 * sum_b (h_b X_b) . B_a.
 */
template <typename Value>
inline void hourglass_sums(const Value x[8], Value mode[4])
{
  const Value a = x[0] + x[1] - x[2] - x[3], b = x[4] + x[5] - x[6] - x[7];
  const Value c = x[0] - x[1] - x[2] + x[3], d = x[4] - x[5] - x[6] + x[7];
  const Value e = x[0] - x[1] + x[2] - x[3], f = x[4] - x[5] + x[6] - x[7];
  mode[0] = a - b;
  mode[1] = c - d;
  mode[2] = e + f;
  mode[3] = f - e;
}

/** Back: f_a = sum_m h_ma mode_m for the eight corners, the forces whose
    work with x_a is that of mode_m with hourglass_sums(x)_m. The transpose
    of hourglass_sums(): sum_a f_a . x_a = sum_m mode_m . (sums of x)_m. f in
    the unit of mode, overwritten. */
template <typename Value>
inline void hourglass_spread(const Value mode[4], Value f[8])
{
  const Value p = mode[2] - mode[3], m = mode[2] + mode[3];
  f[0] = mode[0] + mode[1] + p;
  f[1] = mode[0] - mode[1] - p;
  f[2] = p - mode[0] - mode[1];
  f[3] = mode[1] - mode[0] - p;
  f[4] = m - mode[0] - mode[1];
  f[5] = mode[1] - mode[0] - m;
  f[6] = mode[0] + mode[1] + m;
  f[7] = mode[0] - mode[1] - m;
}
} // namespace sabot

#endif
