// Runs verification problems and prints their checks.
#include "verification/problem.h"

#include "sabot/base/error.h"
#include "sabot/base/nearest_name.h"
#include "sabot/output/file_tools.h"

#include <nlohmann/json.hpp>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <sstream>

namespace sabot
{
bool Check::pass() const
{
  if (!std::isfinite(got))
    return false;
  if (kind == Kind::at_most)
    return got <= expected + tolerance;
  if (kind == Kind::at_least)
    return got >= expected - tolerance;
  return kind == Kind::reported || std::abs(got - expected) <= tolerance;
}

std::vector<VerificationProblem> &verification_problems()
{
  static std::vector<VerificationProblem> problems;
  return problems;
}

RegisterProblem::RegisterProblem(const VerificationProblem &problem)
{
  auto &problems = verification_problems();
  auto position = problems.begin();
  while (position != problems.end() && position->name < problem.name)
    ++position;
  problems.insert(position, problem);
}

bool VerificationProblem::has_label(const std::string &word) const
{
  std::istringstream words(label);
  for (std::string w; words >> w;)
    if (w == word)
      return true;
  return false;
}

namespace
{
std::vector<VerificationProblem> selected(const std::vector<std::string> &names)
{
  std::vector<VerificationProblem> chosen;
  std::vector<std::string> known;
  for (const VerificationProblem &p : verification_problems())
  {
    known.push_back(p.name);
    std::istringstream words(p.label);
    for (std::string word; words >> word;)
      known.push_back(word);
  }
  for (const std::string &name :
       names.empty() ? std::vector<std::string>{"quick"} : names)
  {
    const std::size_t before = chosen.size();
    for (const VerificationProblem &p : verification_problems())
      if (p.name == name || p.has_label(name) || name == "all")
        chosen.push_back(p);
    if (chosen.size() == before)
      throw InputError("", "no verification problem or label is called \"" +
                               name + "\"" + suggestion(name, known) +
                               "; `sabot verify --list` names them all");
  }
  return chosen;
}

const char *kind_name(const Check::Kind kind)
{
  switch (kind)
  {
  case Check::Kind::near:
    return "near";
  case Check::Kind::at_most:
    return "at most";
  case Check::Kind::at_least:
    return "at least";
  default:
    return "reported";
  }
}
} // namespace

bool verify(const std::vector<std::string> &names, const std::string &json_file)
{
  bool all = true;
  nlohmann::ordered_json report = nlohmann::ordered_json::array();
  std::printf("%-52s %13s %13s %11s  %s\n", "check", "expected", "got",
              "tolerance", "");
  for (const VerificationProblem &problem : selected(names))
  {
    const auto start = std::chrono::steady_clock::now();
    const std::vector<Check> checks = problem.run();
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start)
            .count();
    std::printf("%s (%.1f s)\n", problem.name.c_str(), seconds);
    for (const Check &c : checks)
    {
      all = all && c.pass();
      const char *const relation = c.kind == Check::Kind::at_most    ? "<="
                                   : c.kind == Check::Kind::at_least ? ">="
                                                                     : "";
      const std::string expected = c.kind == Check::Kind::reported
                                       ? "-"
                                       : relation + [&]
      {
        char text[32];
        std::snprintf(text, sizeof(text), "%.6g", c.expected);
        return std::string(text);
      }();
      std::printf("  %-50s %13s %13.6g %11.2g  %-6s %s\n", c.name.c_str(),
                  expected.c_str(), c.got, c.tolerance, c.unit.c_str(),
                  c.kind == Check::Kind::reported ? "measured"
                  : c.pass()                      ? "pass"
                                                  : "FAIL");
      report.push_back({{"problem", problem.name},
                        {"name", c.name},
                        {"expected", c.expected},
                        {"got", c.got},
                        {"tolerance", c.tolerance},
                        {"kind", kind_name(c.kind)},
                        {"unit", c.unit},
                        {"source", c.source},
                        {"pass", c.pass()}});
    }
    std::fflush(stdout);
  }
  if (!json_file.empty())
    write_text(json_file, report.dump(2) + "\n");
  return all;
}

std::string problems_page()
{
  std::ostringstream text;
  text << "<!-- Written by `sabot reference doc/reference`; not to be edited. "
          "-->\n# Verification problems\n\n"
       << "`sabot verify NAME` runs a problem, `sabot verify LABEL` all that "
          "have the label: quick ones are part of the tests, long ones take "
          "minutes, extremes are the suite of extreme conditions.\n\n"
          "| problem | labels | what it compares |\n|---|---|---|\n";
  for (const VerificationProblem &p : verification_problems())
    text << "| " << p.name << " | " << p.label << " | " << p.description
         << " |\n";
  return text.str();
}

void list_problems()
{
  for (const VerificationProblem &p : verification_problems())
    std::printf("%-28s %-14s %s\n", p.name.c_str(), p.label.c_str(),
                p.description.c_str());
}
} // namespace sabot
