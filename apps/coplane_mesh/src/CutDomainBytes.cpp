#include "CutDomainBytes.hpp"

#include <coplane_core/Error.hpp>

#include <cstring>
#include <type_traits>

namespace coplane
{
namespace
{
class Writer
{
public:
  template <class... Items>
  void operator()(const Items&... items)
  {
    (add(items), ...);
  }
  std::string bytes;

private:
  template <class Item>
  void add(const Item& item)
  {
    static_assert(std::is_trivially_copyable_v<Item>);
    bytes.append(reinterpret_cast<const char*>(&item), sizeof(Item));
  }
  void add(const GmshFile::Element& element)
  {
    (*this)(element.entity, element.type, element.id, element.nodes);
  }
  void add(const std::string& text)
  {
    add(text.size());
    bytes += text;
  }
  template <class First, class Second>
  void add(const std::pair<First, Second>& pair)
  {
    add(pair.first);
    add(pair.second);
  }
  template <class Item>
  void add(const std::vector<Item>& items)
  {
    addAll(items);
  }
  template <class Key, class Item>
  void add(const std::map<Key, Item>& items)
  {
    addAll(items);
  }
  template <class Items>
  void addAll(const Items& items)
  {
    add(items.size());
    for (const auto& item : items)
      add(item);
  }
};

class ByteReader
{
public:
  explicit ByteReader(const std::string& bytes) : bytes_(bytes) {}
  template <class... Items>
  void operator()(Items&... items)
  {
    (take(items), ...);
  }
  void demandEnd() const
  {
    if (at_ != bytes_.size())
      refuse();
  }

private:
  [[noreturn]] static void refuse() { fail(ExitCode::Internal, "a cut domain came in pieces"); }

  const char* next(std::size_t size)
  {
    if (size > bytes_.size() - at_)
      refuse();
    at_ += size;
    return bytes_.data() + at_ - size;
  }
  template <class Item>
  void take(Item& item)
  {
    std::memcpy(static_cast<void*>(&item), next(sizeof(Item)), sizeof(Item));
  }
  void take(GmshFile::Element& element)
  {
    (*this)(element.entity, element.type, element.id, element.nodes);
  }
  std::size_t count()
  {
    std::size_t size = 0;
    take(size);
    return size;
  }
  void take(std::string& text)
  {
    const std::size_t size = count();
    text.assign(next(size), size);
  }
  template <class First, class Second>
  void take(std::pair<First, Second>& pair)
  {
    take(pair.first);
    take(pair.second);
  }
  template <class Item>
  void take(std::vector<Item>& items)
  {
    for (std::size_t left = count(); left > 0; --left)
      take(items.emplace_back());
  }
  template <class Key, class Item>
  void take(std::map<Key, Item>& items)
  {
    for (std::size_t left = count(); left > 0; --left)
    {
      std::pair<Key, Item> item;
      take(item);
      items.insert(items.end(), std::move(item));
    }
  }

  const std::string& bytes_;
  std::size_t at_ = 0;
};

/// Names every member once, for both ways.
template <class Domain, class Visit>
void visitMembers(Domain& domain, Visit& visit)
{
  auto& mesh = domain.mesh;
  visit(mesh.physicalNames, mesh.physicalsOfEntity, mesh.nodeIds, mesh.coordinates, mesh.elements,
        domain.joints, domain.measures, domain.blockVolumes, domain.notes, domain.joined,
        domain.stubs, domain.slivers, domain.changes, domain.worstBefore, domain.worst,
        domain.worstPlace);
}
} // namespace

std::string bytesOf(const CutDomain& domain)
{
  Writer writer;
  visitMembers(domain, writer);
  return std::move(writer.bytes);
}

CutDomain cutDomainOf(const std::string& bytes)
{
  CutDomain domain;
  ByteReader reader(bytes);
  visitMembers(domain, reader);
  reader.demandEnd();
  return domain;
}
} // namespace coplane
