// Draws charts of a study and sections through runs as PNG files:
// sabot-charts DRAWINGS.json FOLDER. A program of its own, as VTK's rendering
// ends the process where it finds no display.

#include "section.h"
#include "xy_chart.h"

#include <nlohmann/json.hpp>

#include <cstdlib>
#include <fstream>
#include <iostream>

int main(int argc, char **argv)
{
  if (argc != 3)
  {
    std::cerr << "usage: sabot-charts DRAWINGS.json FOLDER" << std::endl;
    return 1;
  }
  if (std::getenv("DISPLAY") == nullptr)
  {
    std::cerr << "error: no DISPLAY; use xvfb-run -a" << std::endl;
    return 4;
  }
  std::ifstream file(argv[1]);
  const nlohmann::json drawings = nlohmann::json::parse(file, nullptr, false);
  if (!drawings.is_array())
  {
    std::cerr << "error: cannot read \"" << argv[1] << "\"" << std::endl;
    return 4;
  }
  // One that fails does not stop the others.
  int code = 0;
  for (const nlohmann::json &drawing : drawings)
    try
    {
      if (drawing.value("kind", "chart") == "section")
        sabot_charts::draw_section(drawing);
      else if (!sabot_charts::draw_chart(drawing, argv[2]))
        throw std::runtime_error("cannot write a picture to \"" +
                                 std::string(argv[2]) + "\"");
    }
    catch (const std::exception &e)
    {
      std::cerr << "error: " << e.what() << std::endl;
      code = 4;
    }
  return code;
}
