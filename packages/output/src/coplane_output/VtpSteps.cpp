#include <coplane_core/Text.hpp>
#include <coplane_output/detail/VtpFile.hpp>
#include <coplane_output/detail/VtpSteps.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

namespace coplane
{
namespace
{
/// 12 of wall_planes_0012.vtp
int numberOfStep(const std::string& name)
{
  return std::atoi(name.substr(name.rfind('_') + 1).c_str());
}

constexpr const char* beginningOfComment = "<!-- coplane run ";

std::string commentOf(const std::string& run)
{
  return beginningOfComment + run + " -->";
}

/// Series and steps say so at their beginning; nothing else is read as a whole. Steps that were
/// written before they had a comment have names of joints there.
bool isOfCoplane(const std::string& file)
{
  if (!isPlainFile(file))
    return false; // opening a pipe would wait
  std::string start(512, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(start.data(), std::streamsize(start.size()));
  return start.find(beginningOfComment) != std::string::npos ||
         start.find("Name=\"joint_names\"") != std::string::npos;
}

std::string contentOf(const std::filesystem::path& file)
{
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// Files of the steps of a series, by its text, without folder.
std::vector<std::string> stepsNamed(const std::string& series, const std::string& base)
{
  static const std::regex entry("file=\"([^\"/]*_[0-9]{1,9}\\.vtp)\"");
  const std::string stem = std::filesystem::path(base).filename().string() + "_";
  const std::string mine = xmlText(stem);
  std::vector<std::string> names;
  for (auto step = std::sregex_iterator(series.begin(), series.end(), entry);
       step != std::sregex_iterator(); ++step)
    if (const std::string name = (*step)[1]; name.rfind(mine, 0) == 0)
      names.push_back(stem + name.substr(mine.size()));
  return names;
}

/// Behind all files of steps that are there.
int firstFreeNumber(const std::string& base)
{
  const std::filesystem::path path(base);
  const std::string stem = path.filename().string() + "_";
  static const std::regex end(R"([0-9]{1,9}\.vtp)");
  int first = 0;
  std::error_code error;
  for (const auto& file : std::filesystem::directory_iterator(
           path.has_parent_path() ? path.parent_path() : std::filesystem::path("."), error))
    if (const std::string name = file.path().filename().string();
        name.rfind(stem, 0) == 0 && std::regex_match(name.substr(stem.size()), end))
      first = std::max(first, numberOfStep(name) + 1);
  return first;
}
} // namespace

VtpSteps::VtpSteps(const std::string& base, const std::string& run, bool continues,
                   const std::string& steps)
    : base_(base), run_(run), continues_(continues)
{
  std::istringstream lines(steps);
  for (std::string line; std::getline(lines, line);)
    steps_.emplace_back(std::strtod(line.c_str(), nullptr), line.substr(line.find(' ') + 1));
  if (!steps_.empty())
    firstNumber_ = numberOfStep(steps_.front().second);
  clearTheWay();
  series_.emplace(placeOfFile(base_ + ".pvd")); // a link stays one
  series_->remember();
  writeSeries();
}

std::string VtpSteps::position() const
{
  std::string text;
  for (const auto& [time, name] : steps_)
    text += fmt::format("{:.17g} {}\n", time, name);
  return text;
}

std::string VtpSteps::comment() const
{
  return commentOf(run_);
}

void VtpSteps::add(Real time, const std::string& text)
{
  const std::string file = fmt::format("{}_{:04}.vtp", base_, firstNumber_ + int(steps_.size()));
  steps_.emplace_back(time, std::filesystem::path(file).filename().string());
  // Those of this series have been removed: what has the name is of somebody else.
  ReplacedFile(file).replace(text);
  writeSeries();
}

/// A new run removes the steps of an earlier one: those that its series names, and no others. A
/// restart goes on with its own series; if another run has written one of that name, or this one
/// has not, that is put aside, its steps stay, and new ones are counted on from what is there.
void VtpSteps::clearTheWay()
{
  const std::string series = base_ + ".pvd";
  std::error_code error;
  const bool isSeries = isOfCoplane(continues_ ? placeOfFile(series) : series);
  const std::string all = isSeries ? contentOf(series) : "";
  const auto removeFrom = [&](int first)
  {
    for (const std::string& name : stepsNamed(all, base_))
      if (numberOfStep(name) >= first)
      {
        makeWayFor(fileOf(name), isOfCoplane);
        std::filesystem::remove(fileOf(name), error);
      }
  };
  if (!continues_)
  {
    removeFrom(0);
    makeWayFor(series, [&](const std::string&) { return isSeries; });
    return;
  }
  const bool isOwn =
      !wouldBeLost(placeOfFile(series)) || all.find(commentOf(run_)) != std::string::npos;
  if (isOwn && !steps_.empty())
  {
    removeFrom(firstNumber_ + int(steps_.size())); // later than the checkpoint
    return;
  }
  steps_.clear();
  firstNumber_ = firstFreeNumber(base_);
  if (wouldBeLost(series))
    putForeignFileAside(series);
}

std::string VtpSteps::fileOf(const std::string& step) const
{
  return std::filesystem::path(base_).replace_filename(step).string();
}

void VtpSteps::writeSeries()
{
  std::string text = "<?xml version=\"1.0\"?>\n" + commentOf(run_) +
                     "\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
                     "  <Collection>\n";
  for (const auto& [time, name] : steps_)
    text +=
        fmt::format("    <DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", time, xmlText(name));
  text += "  </Collection>\n</VTKFile>\n";
  series_->replace(text);
}
} // namespace coplane
