// Tools that all folders stand on: sums, quantities, names, files, text.
#include "sabot/base/entry_aliases.h"
#include "sabot/base/error_report.h"
#include "sabot/base/exact_sum.h"
#include "sabot/base/nearest_name.h"
#include "sabot/base/parameter_file.h"
#include "sabot/base/parameters.h"
#include "sabot/base/text.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>

namespace
{
using namespace sabot;

TEST(Errors, memory_that_does_not_suffice_has_a_name)
{
  const auto message = [](const std::function<void()> &work)
  {
    try
    {
      within_memory("the outer", [&]() { within_memory("the inner", work); });
    }
    catch (const MemoryError &e)
    {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_EQ(message([]() {}), "");
  // Neither the size that no address space has, nor the throw by hand.
  std::vector<double> values;
  for (const std::string &said :
       {message([]() { throw std::bad_alloc(); }),
        message([&]() { values.resize(values.max_size() + 1); })})
    EXPECT_EQ(said.find("memory does not suffice for the inner: the process"),
              0U)
        << said;
  EXPECT_THROW(within_memory("x", []() { throw IOError("y"); }), IOError);
}

TEST(Errors, of_libraries_are_one_line)
{
  EXPECT_EQ(in_one_line("-----\nAn error occurred in line <3> of file\n"
                        "Additional information: \n    no  such\n    cell\n\n"
                        "Stacktrace:\n-----------\n#0 /lib\n-----\n"),
            "no such cell");
  EXPECT_EQ(in_one_line("two\nlines"), "two lines");
  EXPECT_EQ(in_one_line(""), "an error without a message");
}

TEST(ExactSum, does_not_depend_on_the_order)
{
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> uniform(-1., 1.);
  std::vector<double> values(1000);
  for (double &v : values)
    v = uniform(generator) * std::pow(10., 8. * uniform(generator));
  ExactSum forward, backward;
  for (const double v : values)
    forward.add(v);
  std::reverse(values.begin(), values.end());
  for (const double v : values)
    backward.add(v);
  EXPECT_EQ(forward.value(), backward.value());
  backward.subtract(forward);
  EXPECT_EQ(backward.value(), 0.);
}

/** Of @p values from the first to the last, in blocks of @p block. */
double sum_by_blocks(const std::vector<double> &values, const std::size_t block)
{
  ExactSum sum;
  for (std::size_t i = 0; i < values.size(); i += block)
    sum.add(&values[i], std::min(block, values.size() - i));
  return sum.value();
}

TEST(ExactSum, takes_terms_in_blocks_of_any_size_and_order)
{
  // Of all sizes that bodies have, around the bounds of parts, and too large
  // for parts.
  std::mt19937 generator(11);
  std::uniform_real_distribution<double> uniform(-1., 1.);
  std::vector<double> values = {0.,
                                -0.,
                                16384.,
                                -16384.,
                                5e14,
                                1e-40,
                                std::ldexp(1., -29),
                                std::ldexp(1., -72)};
  for (int i = 0; i < 30000; ++i)
    values.push_back(uniform(generator) *
                     std::pow(2., 19. + 39. * uniform(generator)));
  for (int i = 0; i < 30000; ++i)
    values.push_back(uniform(generator) *
                     std::pow(2., -40. + 40. * uniform(generator)));
  ExactSum cut;
  for (const double v : values)
    cut.add(v);
  const double sum = sum_by_blocks(values, values.size());
  EXPECT_DOUBLE_EQ(sum, cut.value());
  std::vector<double> none = values;
  for (const double v : values)
    none.push_back(-v);
  for (const std::size_t block : {1, 3, 256, 5000, 100000})
  {
    std::shuffle(values.begin(), values.end(), generator);
    std::shuffle(none.begin(), none.end(), generator);
    EXPECT_EQ(sum_by_blocks(values, block), sum) << block;
    EXPECT_EQ(sum_by_blocks(none, block), 0.) << block;
  }
  // Exactly the terms, above the unit.
  EXPECT_EQ(sum_by_blocks(std::vector<double>(1 << 20, 16383.9), 1 << 20),
            std::ldexp(16383.9, 20));
  EXPECT_EQ(sum_by_blocks({std::ldexp(1.25, -110)}, 1), std::ldexp(1.25, -110));
  values.push_back(std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(std::isnan(sum_by_blocks(values, 256)));
  EXPECT_TRUE(std::isnan(sum_by_blocks({1., 1e20}, 2)));
  ExactSum by_terms;
  {
    ExactTerms terms(by_terms);
    values.pop_back();
    for (const double v : values)
      terms.add(v);
  }
  EXPECT_EQ(by_terms.value(), sum);
}

TEST(ExactSum, keeps_invalid_terms_visible)
{
  ExactSum sum;
  sum.add(0.1);
  EXPECT_DOUBLE_EQ(sum.value(), 0.1);
  sum.add(std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(std::isnan(sum.value()));
  ExactSum large;
  large.add(1e20);
  EXPECT_TRUE(std::isnan(large.value()));
}

TEST(ExactSum, holds_bodies_of_micrometers_and_of_a_kilometer)
{
  // Small ones that add up, large ones that cancel, in any order.
  std::vector<double> values = {1e-24, 3e-30,  -5e-27, 2e4,  7e4,
                                -9e13, 1.5e14, 3e17,   9e17, -4e16};
  const auto sum_of = [](const std::vector<double> &values)
  {
    ExactSum sum;
    for (const double v : values)
      sum.add(v);
    return sum;
  };
  EXPECT_NEAR(sum_of({1e-24, 3e-30, -5e-27}).value(), 0.995003e-24, 1e-33);
  EXPECT_DOUBLE_EQ(sum_of(std::vector<double>(1000, 7e15)).value(), 7e18);
  EXPECT_DOUBLE_EQ(sum_of(std::vector<double>(1000, -7e15)).value(), -7e18);
  EXPECT_DOUBLE_EQ(sum_of(std::vector<double>(100, 2e4)).value(), 2e6);
  EXPECT_DOUBLE_EQ(sum_of({-65536.}).value(), -65536.);
  EXPECT_DOUBLE_EQ(sum_of({-16384., 16384.25}).value(), 0.25);
  const ExactSum forward = sum_of(values);
  for (const double v : std::vector<double>(values))
    values.push_back(-v);
  std::shuffle(values.begin(), values.end(), std::mt19937(3));
  EXPECT_EQ(sum_of(values).value(), 0.);
  ExactSum none = forward;
  none.subtract(forward);
  EXPECT_EQ(none.value(), 0.);
  none.subtract(forward);
  EXPECT_EQ(none.value(), -forward.value());
  none.add(forward);
  EXPECT_EQ(none.value(), 0.);
}

TEST(Quantity, units_dimensions_and_ranges)
{
  const Pattern length = quantity(Dimension::length, 1e-6, 1.);
  EXPECT_TRUE(length.match("12.7 mm"));
  EXPECT_TRUE(length.match("0.0127"));
  EXPECT_FALSE(length.match("12.7 kg"));
  EXPECT_FALSE(length.match("12.7 m"));
  EXPECT_FALSE(length.match("-1 mm"));
  EXPECT_FALSE(length.match("mm"));
  EXPECT_FALSE(length.match("nan"));
  EXPECT_FALSE(length.match("inf"));
  EXPECT_FALSE(length.match("1 mm, 2 mm"));
  const Pattern three = quantities(Dimension::length, 3, 3, 0., 1.);
  EXPECT_TRUE(three.match("1 mm, 2 mm, 3 cm"));
  EXPECT_FALSE(three.match("1 mm, 2 mm"));
  EXPECT_FALSE(three.match("1 mm, 2 mm, "));

  Parameters prm;
  prm.declare_entry("Stress", "324 MPa", quantity(Dimension::pressure), "");
  prm.declare_entry("Size", "1 mm, 2 cm",
                    quantities(Dimension::length, 2, 2, 0., 1.), "");
  EXPECT_DOUBLE_EQ(get_quantity(prm, "Stress"), 324e6);
  EXPECT_DOUBLE_EQ(get_quantities(prm, "Size")[1], 0.02);
}

TEST(Text, is_trimmed_split_and_joined)
{
  EXPECT_EQ(trim(" \t a b\r\n"), "a b");
  EXPECT_EQ(trim(" \n"), "");
  EXPECT_EQ(split("a; ;b ;", ';'), (std::vector<std::string>{"a", "", "b"}));
  EXPECT_TRUE(split("", ';').empty());
  EXPECT_EQ(join({"a", "b", "c"}, "/"), "a/b/c");
  EXPECT_EQ(formatted("%.3g mm", 2. / 3.), "0.667 mm");
  EXPECT_TRUE(lines_of("/no/such/file").empty());
}

TEST(Text, knows_utf8)
{
  for (const std::string text :
       {"", "plain", "Pr\u00fcfk\u00f6rper", "\u2212", "\U0001F600"})
    EXPECT_FALSE(first_not_utf8(text)) << text;
  // Latin-1, a lone continuation, cut off, overlong, a surrogate, too large.
  EXPECT_EQ(*first_not_utf8("Pr\xfc"), 2u);
  for (const std::string text : {"\x80", "\xe2\x88", "\xc0\xaf", "\xe0\x80\xaf",
                                 "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xff"})
    EXPECT_EQ(first_not_utf8(text).value_or(9), 0u);
  EXPECT_EQ(replaced("a--b-", "-", "+-"), "a+-+-b+-");
}

TEST(Quantity, signs_of_typographers)
{
  EXPECT_DOUBLE_EQ(*read_quantity("\u2212300 m/s"), -300.);
  EXPECT_DOUBLE_EQ(*read_quantity("30 \u00b5s"), 30e-6);
  EXPECT_DOUBLE_EQ(*read_quantity("30 \u03bcm"), 30e-6);
  EXPECT_DOUBLE_EQ(*read_quantity("7.8 g/cm\u00b3"), 7800.);
  EXPECT_TRUE(is_told_in("10 km/s", "m/s"));
  EXPECT_TRUE(is_told_in("10", "m/s"));
  EXPECT_FALSE(is_told_in("10 mm", "m/s"));
  EXPECT_TRUE(is_told_in("10", "1"));
  EXPECT_FALSE(is_told_in("10 mm", "1"));
}

TEST(NearestName, finds_the_likely_one)
{
  EXPECT_EQ(nearest_name("nodal spcing", {"Size", "Nodal spacing", "Center"}),
            "Nodal spacing");
}

class Files : public testing::Test
{
protected:
  void SetUp() override
  {
    char name[] = "/tmp/sabot-test-XXXXXX";
    folder = mkdtemp(name);
    prm.declare_entry("Title", "", any_text(), "");
    prm.enter_subsection("Bodies");
    prm.enter_subsection("plate");
    prm.declare_entry("Cell size", "1 mm", quantity(Dimension::length), "");
    prm.declare_entry("Kind", "FEM", one_of("FEM|SPG"), "");
    prm.leave_subsection();
    prm.leave_subsection();
  }
  void TearDown() override { std::filesystem::remove_all(folder); }
  std::string write(const std::string &name, const std::string &text)
  {
    const std::string file = folder + "/" + name;
    std::ofstream(file) << text;
    return file;
  }
  std::string message(const std::string &text,
                      const std::vector<std::string> &overrides = {})
  {
    try
    {
      const std::string file = write("scene.prm", text);
      ParameterFile(file, overrides).parse_into(prm);
    }
    catch (const InputError &e)
    {
      return e.what();
    }
    return "";
  }
  std::string folder;
  Parameters prm;
};

TEST_F(Files, entries_are_declared_in_their_subsection)
{
  EXPECT_TRUE(prm.is_declared("Title"));
  EXPECT_FALSE(prm.is_declared("Kind"));
  const EnteredSubsection entered(prm, "Bodies", "plate");
  EXPECT_TRUE(prm.is_declared("Kind"));
  EXPECT_FALSE(prm.is_declared("Title"));
  EXPECT_EQ(prm.entry_names(), (std::vector<std::string>{"Cell size", "Kind"}));
}

#define EXPECT_CONTAINS(text, part)                                            \
  EXPECT_NE(std::string(text).find(part), std::string::npos) << (text)

TEST_F(Files, what_is_not_declared_is_no_empty_text)
{
  Parameters prm;
  {
    const EnteredSubsection entered(prm, "Bodies", "plate");
    prm.declare_entry("Zone", "fixed", any_text(), "");
    EXPECT_EQ(prm.get("Zone"), "fixed");
    EXPECT_THROW(prm.get("Start zone"), std::logic_error);
    // Entered once more, it is another section.
    const EnteredSubsection again(prm, "Bodies", "plate");
    EXPECT_THROW(prm.get("Zone"), std::logic_error);
  }
  EXPECT_THROW(prm.get("Zone"), std::logic_error);
}

TEST_F(Files, includes_are_looked_up_beside_the_includer)
{
  std::filesystem::create_directory(folder + "/sub");
  write("sub/base.prm", "include more.prm\nset Title = base\n");
  write(
      "sub/more.prm",
      "subsection Bodies\nsubsection plate\nset Cell size = 3 mm\nend\nend\n");
  const std::string file =
      write("scene.prm", "include sub/base.prm\nset Title = mine # comment\n");
  const ParameterFile parsed(file, {"Bodies/plate/Kind=SPG"});
  parsed.parse_into(prm);
  EXPECT_EQ(prm.get("Title"), "mine");
  prm.enter_subsection("Bodies");
  prm.enter_subsection("plate");
  EXPECT_DOUBLE_EQ(get_quantity(prm, "Cell size"), 3e-3);
  EXPECT_EQ(prm.get("Kind"), "SPG");
  EXPECT_EQ(parsed.subsections("Bodies"), std::vector<std::string>{"plate"});
}

TEST_F(Files, a_misspelt_entry_gets_file_line_and_a_suggestion)
{
  const std::string m = message(
      "subsection Bodies\nsubsection plate\nset Cell siez = 1\nend\nend");
  EXPECT_CONTAINS(m, "scene.prm:3: ");
  EXPECT_CONTAINS(m, "\"Cell siez\"");
  EXPECT_CONTAINS(m, "did you mean \"Cell size\"?");
  EXPECT_CONTAINS(message("subsection Bodys\nset Title = 1\nend"),
                  "did you mean \"Bodies\"?");
  EXPECT_CONTAINS(message("set Cell size = 1 mm"), "belongs to Bodies/plate");
}

TEST_F(Files, a_name_unlike_any_gets_the_list)
{
  const std::string m = message(
      "subsection Bodies\nsubsection plate\nset Velocity = 1\nend\nend");
  EXPECT_EQ(m.find("did you mean"), std::string::npos) << m;
  EXPECT_CONTAINS(m, "; allowed here: ");
  EXPECT_CONTAINS(m, "Cell size");
}

TEST(NearestName, is_spelled_alike_or_a_part)
{
  const std::vector<std::string> names = {"steel", "copper", "al6061-t6",
                                          "initial velocity"};
  EXPECT_EQ(nearest_name("stele", names), "steel");
  EXPECT_EQ(nearest_name("AL6061", names), "al6061-t6");
  EXPECT_EQ(nearest_name("Velocity", names), "initial velocity");
  EXPECT_EQ(nearest_name("copper plate", names), "copper");
  for (const std::string other : {"", "x", "tungsten", "armour", "concrete"})
    EXPECT_EQ(nearest_name(other, names), "") << other;
  EXPECT_EQ(suggestion_or_list("tungsten", names),
            "; there is: steel, copper, al6061-t6, initial velocity");
  EXPECT_EQ(suggestion_or_list("coper", names), "; did you mean \"copper\"?");
  EXPECT_EQ(suggestion_or_list("coper", {}), "");
  const std::vector<std::string> many(40, "steel");
  EXPECT_CONTAINS(suggestion_or_list("tungsten", many), "steel and 10 more");
}

TEST_F(Files, old_names_are_accepted_and_said_once)
{
  const auto &[old_name, name] = entry_aliases().front();
  prm.declare_entry(name, "0", any_text(), "");
  const ParameterFile parsed(
      write("scene.prm", "set " + old_name + " = 1 # old\n"),
      {old_name + "=2"});
  EXPECT_EQ(parsed.value(name, ""), "2");
  EXPECT_TRUE(parsed.is_set(name));
  EXPECT_EQ(parsed.origin(name), "--set \"" + old_name + "=2\"");
  parsed.parse_into(prm);
  EXPECT_EQ(prm.get(name), "2");
  ASSERT_EQ(parsed.notes().size(), 1u);
  EXPECT_CONTAINS(parsed.notes()[0], "is now called \"" + name + "\"");
  EXPECT_CONTAINS(parsed.notes()[0], "scene.prm:1");
  // Both names are one entry.
  EXPECT_CONTAINS(message("set " + old_name + " = 1\nset " + name + " = 2\n"),
                  "already set at");
}

TEST_F(Files, a_wrong_value_is_told_with_what_would_be_right)
{
  const std::string m = message(
      "subsection Bodies\nsubsection plate\nset Cell size = 1 kg\nend\nend");
  EXPECT_CONTAINS(m, "scene.prm:3: ");
  EXPECT_CONTAINS(m, "\"1 kg\"");
  EXPECT_CONTAINS(m, "a length");
  EXPECT_CONTAINS(message("", {"Bodies/plate/Kind=SPH"}), "one of FEM, SPG");
}

TEST_F(Files, structure_is_checked)
{
  EXPECT_CONTAINS(message("subsection Bodies\n"), "scene.prm:1: ");
  EXPECT_CONTAINS(message("end\n"), "without a subsection");
  EXPECT_CONTAINS(message("sett Title = x\n"), "scene.prm:1: expected set");
  EXPECT_CONTAINS(message("set Title = a\nset Title = b\n"), "already set at");
  EXPECT_CONTAINS(message("include nowhere.prm\n"), "nowhere.prm");
  EXPECT_CONTAINS(message("include scene.prm\n"), "includes itself");
  EXPECT_CONTAINS(message("", {"Title"}), "Section/Name=value");
  EXPECT_THROW(ParameterFile(folder + "/none.prm", {}), InputError);
}

TEST_F(Files, the_expanded_file_reads_back)
{
  ParameterFile(write("a.prm", "set Title = round trip\nsubsection Bodies\n"
                               "subsection plate\nset Cell size = 2 cm\nend\n"
                               "end\n"),
                {})
      .parse_into(prm);
  std::ostringstream text;
  print_expanded(prm, text);
  prm.set("Title", "");
  ParameterFile(write("b.prm", text.str()), {}).parse_into(prm);
  EXPECT_EQ(prm.get("Title"), "round trip");
  std::ostringstream again;
  print_expanded(prm, again);
  EXPECT_EQ(text.str(), again.str());
}
} // namespace
