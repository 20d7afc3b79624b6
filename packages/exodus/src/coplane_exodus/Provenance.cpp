#include <coplane_core/TextFile.hpp>
#include <coplane_exodus/ExodusCalls.hpp>
#include <coplane_exodus/NetcdfHeader.hpp>
#include <coplane_exodus/Provenance.hpp>

#include <exodusII.h>

#include <array>
#include <filesystem>
#include <memory>
#include <vector>

namespace coplane
{
namespace
{
constexpr const char* infoBeginning = "coplane run ";

/// Room for texts that Exodus copies, each with an end.
template <int Length>
struct Texts
{
  std::vector<std::array<char, Length + 1>> bytes;
  std::vector<char*> pointers;
  explicit Texts(int count) : bytes(std::size_t(count))
  {
    for (auto& text : bytes)
    {
      text.fill('\0');
      pointers.push_back(text.data());
    }
  }
};

struct Provenance
{
  std::string program; ///< of the last QA record
  bool hasNodalVariables = false;
  std::string run; ///< that the first info line names
};

std::string lastProgram(int exoid)
{
  const int records = int(ex_inquire_int(exoid, EX_INQ_QA));
  if (records <= 0)
    return "";
  Texts<MAX_STR_LENGTH> text(4 * records);
  using Record = char* [4];
  const auto pointers = std::make_unique<Record[]>(records);
  for (int i = 0; i < 4 * records; ++i)
    pointers[i / 4][i % 4] = text.pointers[i];
  return ex_get_qa(exoid, pointers.get()) >= 0 ? pointers[records - 1][0] : "";
}

std::string runOfFirstLine(int exoid)
{
  const int lines = int(ex_inquire_int(exoid, EX_INQ_INFO));
  if (lines <= 0)
    return "";
  Texts<MAX_LINE_LENGTH> text(lines);
  if (ex_get_info(exoid, text.pointers.data()) < 0)
    return "";
  const std::string first = text.pointers[0], beginning = infoBeginning;
  return first.rfind(beginning, 0) == 0 ? first.substr(beginning.size()) : "";
}

std::optional<Provenance> provenanceOf(const std::string& file)
{
  std::error_code error;
  // Coplane writes no other format; of other files the library says a lot.
  if (!std::filesystem::is_regular_file(file, error) || !beginsWith(file, "CDF") ||
      !classicHeaderFitsFile(file))
    return std::nullopt;
  quietExodus();
  int computed = 8, stored = 0;
  float version = 0;
  const int exoid = ex_open(file.c_str(), EX_READ, &computed, &stored, &version);
  if (exoid < 0)
    return std::nullopt;
  int variables = 0;
  Provenance provenance;
  provenance.program = lastProgram(exoid);
  provenance.hasNodalVariables =
      ex_get_variable_param(exoid, EX_NODAL, &variables) >= 0 && variables > 0;
  provenance.run = runOfFirstLine(exoid);
  ex_close(exoid);
  return provenance;
}
} // namespace

std::string infoLineOf(const std::string& run)
{
  return infoBeginning + run;
}

std::optional<std::string> runOfResults(const std::string& file)
{
  const std::optional<Provenance> provenance = provenanceOf(file);
  if (!provenance || provenance->program != programOfResults || !provenance->hasNodalVariables)
    return std::nullopt;
  return provenance->run;
}

bool isMeshOfCoplane(const std::string& file)
{
  const std::optional<Provenance> provenance = provenanceOf(file);
  return provenance && provenance->program == programOfMeshes && !provenance->hasNodalVariables;
}
} // namespace coplane
