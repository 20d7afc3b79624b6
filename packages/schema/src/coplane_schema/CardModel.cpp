#include "CardModel.hpp"

namespace coplane
{
bool sameTexts(const Key& a, const Key& b)
{
  const auto texts = [](const Key& key)
  {
    return std::tie(key.name, key.kind, key.unit, key.defaultText, key.meaning, key.example,
                    key.required, key.choices, key.lower, key.upper, key.lowerOpen, key.upperOpen,
                    key.length, key.leastLength, key.notAllZero, key.byDimension, key.dimension);
  };
  return !a.isGroup() && texts(a) == texts(b);
}
} // namespace coplane
