// Mesh files of all formats with mistakes: read or refused in one line.
#include "gmsh_text.h"
#include "vtk_files.h"

#include <cstdlib>
#include <filesystem>
#include <random>

namespace
{
using namespace sabot;

/** Mistakes in a text, the same for each seed. */
class Mistakes
{
public:
  explicit Mistakes(const unsigned int seed) : random(seed) {}

  std::string operator()(std::string text)
  {
    for (std::size_t n = below(4) + 1; n > 0; --n)
      change(text);
    return text;
  }

private:
  std::size_t below(const std::size_t n) { return n > 0 ? random() % n : 0; }

  void change(std::string &text)
  {
    static const std::vector<std::string> numbers = {"0",
                                                     "-1",
                                                     "1",
                                                     "3",
                                                     "8",
                                                     "1e300",
                                                     "nan",
                                                     "2000000000",
                                                     "-2147483648",
                                                     "9223372036854775807",
                                                     "18446744073709551616",
                                                     "1e",
                                                     "",
                                                     "x"};
    const std::size_t at = below(text.size());
    switch (below(7))
    {
    case 0: // another number
    case 1:
    {
      const std::size_t first = text.find_first_of("0123456789", at);
      if (first != std::string::npos)
        text.replace(first,
                     std::min(text.find_first_not_of("0123456789.", first),
                              text.size()) -
                         first,
                     numbers[below(numbers.size())]);
      break;
    }
    case 2: // other bytes
      for (std::size_t n = below(8) + 1; n > 0 && !text.empty(); --n)
        text[below(text.size())] = char(below(256));
      break;
    case 3: // without a part
      text.erase(at, below(20) * below(20));
      break;
    case 4: // the end is gone
      if (below(4) == 0)
        text.resize(at);
      break;
    case 5: // a line from elsewhere
    {
      const std::size_t from = text.find('\n', below(text.size())),
                        to = text.find('\n', at);
      if (from != std::string::npos && to != std::string::npos)
        text.insert(to, text.substr(from, text.find('\n', from + 1) - from));
      break;
    }
    default: // a digit that is another one
    {
      const std::size_t first = text.find_first_of("0123456789", at);
      if (first != std::string::npos)
        text[first] = '0' + below(10);
    }
    }
  }

  std::mt19937 random;
};

std::string deck()
{
  return "*Part, name=P\n" + Block().abaqus(1001) +
         "*Nset, nset=low, generate\n1, 9, 1\n*Elset, elset=up, generate\n"
         "1005, 1008, 1\n*Surface, name=top\nup, S2\n"
         "*Surface, type=NODE, name=tip\nlow, 1.\n"
         "*Solid Section, elset=up, material=m\n,\n*End Part\n"
         "*Assembly, name=A\n*Instance, name=P-1, part=P\n0., 0., 1.\n"
         "0., 0., 0., 0., 0., 1., 30.\n*End Instance\n"
         "*Instance, name=P-2, part=P\n9., 0., 0.\n*End Instance\n"
         "*Nset, nset=far, instance=P-2\nlow\n*Surface, name=s\nP-1.up, S1\n"
         "*End Assembly\n*Material, name=m\n*Elastic\n1., 0.3\n";
}

TEST(MeshFuzz, every_file_is_read_or_refused)
{
  // More in the environment, for a longer search (scripts/sanitize.sh).
  const char *const wanted = std::getenv("SABOT_FUZZ_INPUTS");
  const int n_inputs = wanted != nullptr ? std::atoi(wanted) : 1500;
  std::vector<std::pair<std::string, std::string>> sound = {
      {"fuzz.inp", deck()}};
  for (const double version : {2.2, 4., 4.1})
    for (const bool is_binary : {false, true})
      sound.push_back({"fuzz.msh", GmshText(version, is_binary).str()});
  std::vector<std::string> files;
  for (const int version : {42, 51})
    for (const bool is_binary : {false, true})
      files.push_back(write_vtk(version, is_binary));
  for (const int mode : vtu_modes)
    for (const bool is_packed : {false, true})
      files.push_back(write_vtu(mode, is_packed, false));
  for (const std::string &file : files)
    sound.push_back({"fuzz" + std::filesystem::path(file).extension().string(),
                     MeshFile{file, "Mesh file"}.text()});
  int n_read = 0;
  for (int i = 0; i < n_inputs; ++i)
  {
    const auto &[name, text] = sound[i % sound.size()];
    const std::string said = refusal(name, Mistakes(i)(text));
    n_read += said.empty();
    EXPECT_TRUE(said.empty() || has(said, "fuzz.")) << i << ": " << said;
    EXPECT_LT(said.size(), 900u) << i << ": " << said;
    EXPECT_FALSE(has(said, "\n")) << i << ": " << said;
  }
  // Neither is everything refused nor everything taken.
  EXPECT_GT(n_read, n_inputs / 50);
  EXPECT_LT(n_read, n_inputs - n_inputs / 5);
}
} // namespace
