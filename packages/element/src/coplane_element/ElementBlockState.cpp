// What of an element goes into a checkpoint.
#include <coplane_element/ElementBlock.hpp>

#include <algorithm>

namespace coplane
{
std::vector<std::string> ElementBlock::stateColumns() const
{
  std::vector<std::string> names;
  forEachState(
      [&](const char* name, int rows, const Values&)
      {
        for (int row = 0; row < rows; ++row)
          names.push_back(std::string(name) + "." + std::to_string(row));
      });
  names.push_back("volume");
  names.push_back("stable_step");
  return names;
}

void ElementBlock::saveState(int element, Real* row) const
{
  forEachState(
      [&](const char*, int rows, const Values& values)
      {
        for (int k = 0; k < rows; ++k)
          *row++ = values(k, element);
      });
  *row++ = arrays_.volume(element);
  *row = arrays_.stableStep(element);
}

void ElementBlock::restoreState(int element, const Real* row)
{
  // What pads the last batch is a copy of the last element.
  const int end = element == count_ - 1 ? int(arrays_.mass.extent(0)) : element + 1;
  Eroded eroded{element, 0, {}};
  forEachState(
      [&](const char*, int rows, const Values& values)
      {
        for (int k = 0; k < rows; ++k, ++row)
        {
          for (int e = element; e < end; ++e)
            values(k, e) = *row;
          eroded.state.push_back(*row);
        }
      });
  for (int e = element; e < end; ++e)
  {
    arrays_.volume(e) = row[0];
    arrays_.stableStep(e) = row[1];
  }
  eroded.volume = row[0];
  if (!isAlive(element))
    eroded_.push_back(std::move(eroded));
}
} // namespace coplane
