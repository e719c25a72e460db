#ifndef sabot_output_hdf5_tools_h
#define sabot_output_hdf5_tools_h

#include <hdf5.h>

namespace sabot
{
/** Closes an HDF5 handle of any kind. */
class Hdf5Handle
{
public:
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

/** Silences HDF5's own error print-out while it lives. */
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
  H5E_auto2_t function;
  void *data;
};
} // namespace sabot

#endif
