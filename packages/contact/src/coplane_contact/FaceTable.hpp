#pragma once

#include <coplane_contact/Faces.hpp>
#include <coplane_core/Backend.hpp>
#include <coplane_mesh/NodeLayout.hpp>

#include <vector>

namespace coplane
{
/// The faces that this rank knows: its own, sorted by id, then copies of those of other ranks,
/// sorted by id.
class FaceTable
{
public:
  explicit FaceTable(std::vector<Face> local) : local_(std::move(local)), all_(local_) {}

  /// Those of this rank, now; after replaceLocal() others than the first of all().
  const std::vector<Face>& local() const { return local_; }
  std::vector<Face>& local() { return local_; }
  /// As listed last.
  const std::vector<Face>& all() const { return all_; }
  /// all(), for kernels.
  const Array<Face>& forKernels() const { return table_; }
  /// Position in all(), -1 where the face is not here. Call when local() is listed.
  int place(GlobalId id) const;

  /// They are listed with the search that has to follow.
  void replaceLocal(std::vector<Face> local) { local_ = std::move(local); }
  /// @param ghosts sorted by id; the layout knows their nodes
  void list(const std::vector<GhostFace>& ghosts, const NodeLayout& layout);

private:
  std::vector<Face> local_, all_;
  Array<Face> table_;
};
} // namespace coplane
