#pragma once

#include <coplane_core/Real.hpp>

#include <string>
#include <utility>
#include <vector>

namespace coplane
{
/// One value of a deck as written, before it is checked. Aliases are copies here, so that --set
/// changes one place only.
struct DeckNode
{
  enum class Kind
  {
    Nothing, ///< `key:` without a value, or null
    Scalar,
    List,
    Map
  };

  Kind kind = Kind::Nothing;
  std::string text;    ///< of a scalar
  bool quoted = false; ///< scalar in quotes: text, never a number
  bool flow = false;   ///< list or map written on one line, [ ] or { }
  std::string where;   ///< "wall.yaml:12:5", or "--set time.end=1" for a value of the command line
  long order = 0;      ///< sorts messages by place in the file, those of --set last
  std::vector<DeckNode> items; ///< of a list
  std::vector<std::pair<DeckNode, DeckNode>>
      entries; ///< of a map, in the order written, twins included

  /// The first value with this key, or nullptr.
  const DeckNode* find(const std::string& key) const;
  DeckNode* find(const std::string& key);
};

/// Value at a path such as {"conditions", "0", "value"}, or the deepest value on the way to it.
const DeckNode& nodeAt(const DeckNode& root, const std::vector<std::string>& path);

/// Collects all errors of a deck, to be thrown together, and what is odd in it.
class Problems
{
public:
  void add(const DeckNode& at, const std::string& text);
  /// Of a value that is accepted, but most likely not meant.
  void warn(const DeckNode& at, const std::string& text);
  bool empty() const { return problems_.empty(); }
  std::size_t size() const { return problems_.size(); }

  /// One line each, "where: text", in the order of the file.
  std::string text() const;
  /// The same of what is odd, a line each.
  std::vector<std::string> warnings() const;

private:
  std::vector<std::pair<long, std::string>> problems_, warnings_;
};

/// A card where it stands in its file, for what one of its keys demands of another.
struct CardPlace
{
  const DeckNode& node;
  std::string path; ///< such as materials.steel
  Problems& problems;

  bool gives(const std::string& key) const { return node.find(key) != nullptr; }
  /// "materials.steel.key text", at the key or, where it is not given, at the card.
  void problem(const std::string& key, const std::string& text) const;
};

/// What messages call a file, and how large its lengths may be.
struct FileKind
{
  std::string name = "the deck";
  std::string help = "--help-deck"; ///< the option that lists its keys
  std::string example = "mesh: bricks.e";
  Real longest = infinity; ///< numbers in metres beyond are refused [m]
  /// Names of `define` that nothing uses are accepted, as in a stage that has taken out what did.
  bool idleNames = false;
};

/// The text of a file. Throws Error(Deck) when it cannot be read.
std::string readTextFile(const std::string& file, const FileKind& kind = {});

/// Reads YAML. Throws Error(Deck) for wrong syntax, an empty file, several documents, endless
/// aliases.
DeckNode parseYaml(const std::string& text, const std::string& file, const FileKind& kind = {});

/// Applies "a.b.0.c=value" to the tree; the value is YAML. What cannot be reached becomes a
/// problem.
void applyOverride(DeckNode& root, const std::string& assignment, int number, Problems& problems);

/// The same with a value at hand, by a key "a.b.0.c" that stands somewhere in a file; a value that
/// is nothing takes the key out, or leaves nothing in place of an item of a list, so that the
/// others keep their numbers. The item after the last one is new, also that of a list which is not
/// there yet.
void applyChange(DeckNode& root, const DeckNode& path, const DeckNode& value, Problems& problems);

/// The tree as YAML text; reading it again gives the same tree.
std::string toYaml(const DeckNode& root);
} // namespace coplane
