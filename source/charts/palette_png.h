#ifndef sabot_charts_palette_png_h
#define sabot_charts_palette_png_h

#include <string>

class vtkRenderWindow;

namespace sabot_charts
{
/** Write what a window shows as a PNG of at most 256 colors: a third of the
    size of one of true color. @throw std::runtime_error */
void write_palette_png(vtkRenderWindow *window, const std::string &file);
} // namespace sabot_charts

#endif
