#ifndef sabot_bodies_fem_hourglass_h
#define sabot_bodies_fem_hourglass_h

namespace sabot
{
/** The four hourglass base vectors h_m summed with nodal values, by sums and
    differences of pairs (corner order: VTK):
    h_1 = (++--, --++), h_2 = (+--+, -++-), h_3 = (+-+-, +-+-),
    h_4 = (-+-+, +-+-). */
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

/** Sum over modes of h_m times modal values, for the eight corners. */
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
