#ifndef sabot_output_hdf5_tools_h
#define sabot_output_hdf5_tools_h

#include <hdf5.h>

namespace sabot
{
/**
 * Closes an HDF5 handle of any kind when it goes out of scope, so that no early
 * return leaves a file open. Takes the place of the handle in HDF5's calls; a
 * negative one is what a failed call gave, and is not closed.
 */
class Hdf5Handle
{
public:
  /** @p close: what closes this kind, for example H5Dclose. */
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

/** Silences HDF5's own error print-out while it lives: what went wrong the
    caller says in its own words, with the file's name. */
class Hdf5Quiet
{
public:
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
