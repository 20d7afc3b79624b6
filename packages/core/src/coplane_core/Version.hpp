#pragma once

#include <string>

namespace coplane
{
struct Version
{
  std::string number;   ///< of Coplane
  std::string revision; ///< of the source tree, with "-dirty" when it was changed
  std::string compiler;
  std::string flags; ///< build type and processor
  std::string trilinos;
};
const Version& version();
} // namespace coplane
