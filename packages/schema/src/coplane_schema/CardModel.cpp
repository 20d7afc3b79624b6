#include "CardModel.hpp"

namespace coplane
{
void CardPlace::problem(const std::string& key, const std::string& text) const
{
  const DeckNode* const given = node.find(key);
  problems.add(given ? *given : node, path + "." + key + " " + text);
}

bool sameTexts(const Key& a, const Key& b)
{
  const auto texts = [](const Key& key)
  {
    return std::tie(key.name, key.kind, key.unit, key.defaultText, key.meaning, key.example,
                    key.required, key.choices, key.lower, key.upper, key.lowerOpen, key.upperOpen,
                    key.length, key.notAllZero);
  };
  return texts(a) == texts(b);
}
} // namespace coplane
