#include "SchemaReference.hpp"
#include "detail/ReferenceText.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_core/Suggestion.hpp>

#include <algorithm>
#include <set>

namespace coplane
{
namespace
{
using Words = std::vector<std::string>;

bool isPlaceholder(const std::string& word)
{
  return !word.empty() && word.front() == '<';
}

/// The words of a path, without those such as <name> at its end.
Words wordsOf(const std::string& path)
{
  Words words;
  std::size_t begin = 0;
  for (std::size_t end; (end = path.find('.', begin)) != std::string::npos; begin = end + 1)
    words.push_back(path.substr(begin, end - begin));
  words.push_back(path.substr(begin));
  while (words.size() > 1 && isPlaceholder(words.back()))
    words.pop_back();
  return words;
}

/// Whether the first `i` words of a path end with the first `j` of a topic. Words such as <name>
/// may be left out, and stand for any word between others.
bool endsWith(const Words& path, std::size_t i, const Words& topic, std::size_t j)
{
  if (j == 0)
    return true;
  if (i == 0)
    return false;
  const bool isAny = isPlaceholder(path[i - 1]);
  if (isAny && endsWith(path, i - 1, topic, j))
    return true;
  return (path[i - 1] == topic[j - 1] || (isAny && j > 1)) && endsWith(path, i - 1, topic, j - 1);
}

bool has(const Words& words, const std::string& word)
{
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// What a topic has in the groups of a schema.
class Topic
{
public:
  Topic(const Key& schema, const std::string& topic) : topic_(topic), words_(wordsOf(topic))
  {
    collect(schema, "");
  }

  /// The section of that name alone, where there is one.
  const std::string& text() const { return section_.empty() ? all_ : section_; }
  const std::set<std::string>& names() const { return names_; }

private:
  void collect(const Key& group, const std::string& path)
  {
    for (const Key& key : group.keys)
    {
      const std::string here = pathOf(path, key);
      names_.insert(key.name);
      names_.insert(key.choices.begin(), key.choices.end());
      names_.insert(key.models.begin(), key.models.end());
      const Words words = wordsOf(here);
      if (endsWith(words, words.size(), words_, words_.size()))
      {
        writeText(group, key, path, all_);
        if (path.empty())
          writeText(group, key, path, section_);
      }
      else if (has(key.choices, topic_) || has(key.models, topic_))
        writeText(group, key, path, all_);
      else
        collect(key, here);
    }
  }

  std::string topic_, all_, section_;
  Words words_;
  std::set<std::string> names_;
};
} // namespace

std::string topicText(const Key& schema, const std::string& topic)
{
  const Topic found(schema, topic);
  if (!found.text().empty())
    return found.text();
  Words sections;
  for (const Key& key : schema.keys)
    sections.push_back(key.name);
  const Words names(found.names().begin(), found.names().end());
  fail(ExitCode::Usage, "'{}': no section, key, model or choice has this name.{} Sections: {}.",
       shortened(topic), didYouMean(wordsOf(topic).back(), names), listOf(sections, 50));
}
} // namespace coplane
