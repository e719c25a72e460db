// PNG files with few colors.
#include "palette_png.h"

#include <vtkImageData.h>
#include <vtkImageQuantizeRGBToIndex.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkWindowToImageFilter.h>

#include <png.h>

#include <cmath>
#include <stdexcept>
#include <vector>

namespace sabot_charts
{
void write_palette_png(vtkRenderWindow *const window, const std::string &file)
{
  constexpr int n_colors = 256;
  vtkNew<vtkWindowToImageFilter> shot;
  shot->SetInput(window);
  shot->ReadFrontBufferOff();
  vtkNew<vtkImageQuantizeRGBToIndex> quantize;
  quantize->SetInputConnection(shot->GetOutputPort());
  quantize->SetNumberOfColors(n_colors);
  quantize->Update();
  vtkImageData *const image = quantize->GetOutput();
  int size[3];
  image->GetDimensions(size);
  std::vector<png_byte> pixels;
  pixels.reserve(size[0] * size[1]);
  for (int y = size[1] - 1; y >= 0; --y) // VTK counts from the bottom
    for (int x = 0; x < size[0]; ++x)
      pixels.push_back(
          static_cast<png_byte>(image->GetScalarComponentAsDouble(x, y, 0, 0)));
  vtkLookupTable *const table = quantize->GetLookupTable();
  const int n_used = table->GetNumberOfTableValues();
  std::vector<png_byte> colors;
  for (int k = 0; k < n_used; ++k)
    for (int c = 0; c < 3; ++c)
      colors.push_back(static_cast<png_byte>(
          std::lround(255. * table->GetTableValue(k)[c])));
  png_image png = {};
  png.version = PNG_IMAGE_VERSION;
  png.width = size[0];
  png.height = size[1];
  png.format = PNG_FORMAT_RGB_COLORMAP;
  png.colormap_entries = n_used;
  if (png_image_write_to_file(&png, file.c_str(), 0, pixels.data(), 0,
                              colors.data()) == 0)
    throw std::runtime_error("cannot write \"" + file + "\": " + png.message);
}
} // namespace sabot_charts
