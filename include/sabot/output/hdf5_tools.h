#ifndef sabot_output_hdf5_tools_h
#define sabot_output_hdf5_tools_h

#include <hdf5.h>

namespace sabot
{
/**
 * Closes an HDF5 handle of any kind when it goes out of scope, so that no early
 * return leaves a file open. Takes the place of the handle in HDF5's calls; a
 * negative one is what a failed call gave, and is not closed.
 *
 *     const Hdf5Handle file(H5Fopen(name, H5F_ACC_RDONLY, H5P_DEFAULT),
 *                           H5Fclose);
 *     if (file < 0)
 *       throw IOError(...);
 *
 * What closing returns is not looked at: flush before, where it matters whether
 * all was written.
 */
class Hdf5Handle
{
public:
  /**
   * @p close: what closes this kind, for example H5Dclose.
   * Takes the handle over: nobody else may close it.
   */
  Hdf5Handle(const hid_t id, herr_t (*close)(hid_t)) : id(id), close(close) {}
  ~Hdf5Handle()
  {
    if (id >= 0)
      close(id);
  }
  Hdf5Handle(const Hdf5Handle &) = delete;
  operator hid_t() const { return id; }

private:
  const hid_t id;
  herr_t (*const close)(hid_t);
};

/**
 * HDF5 does not close its library when the program ends or MPI does: opened
 * before anything else, it hears of neither. A damaged file that it refuses may
 * stay open inside of it, and closing then ends in "infinite loop closing
 * library". Nothing is lost, as whoever opens a file closes it (Hdf5Handle).
 */
inline const bool hdf5_is_left_at_end = H5dont_atexit() >= 0 && H5open() >= 0;

/**
 * Silences HDF5's own error print-out while it lives: what went wrong the
 * caller says in its own words, with the file's name.
 * HDF5 keeps one such function per error stack, so objects may stand within
 * each other, the inner one ending first. Rank-local.
 */
class Hdf5Quiet
{
public:
  /** Remembers the function that prints and its argument, then sets none. */
  Hdf5Quiet()
  {
    H5Eget_auto2(H5E_DEFAULT, &function, &data);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~Hdf5Quiet() { H5Eset_auto2(H5E_DEFAULT, function, data); }
  Hdf5Quiet(const Hdf5Quiet &) = delete;

private:
  H5E_auto2_t function; // what printed before
  void *data;           // its argument
};
} // namespace sabot

#endif
