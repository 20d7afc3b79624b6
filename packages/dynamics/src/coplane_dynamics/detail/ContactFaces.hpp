#pragma once

#include <coplane_contact/Faces.hpp>
#include <coplane_core/NodeViews.hpp>
#include <coplane_element/ElementBlock.hpp>
#include <coplane_mesh/NodeLayout.hpp>
#include <coplane_mesh/RankMesh.hpp>

#include <utility>
#include <vector>

namespace coplane
{
/// The exterior faces as contact wants them, in the same order. Thickness and modulus of the
/// element behind are those at the birth of a face: at the start, or when erosion lays it bare.
/// @param bodyOfNode number of the body of each node of this rank's elements
/// @param faceGroups groups of faces that are not in that of their block, by face id, sorted
/// @param known faces that exist already, sorted by id: they stay as they are; none at the start
std::vector<Face> contactFaces(const RankMesh& mesh, const std::vector<ElementBlock>& blocks,
                               const std::vector<std::pair<GlobalId, int>>& faceGroups,
                               const std::vector<int>& bodyOfNode,
                               const std::vector<ExteriorFace>& exterior, const ConstNodeVectors& x,
                               const std::vector<Face>* known = nullptr);

/// Sets Face::thin of all exterior faces of this rank, whose mirrors are known. Collective.
void markThinFaces(std::vector<Face>& faces, const NodeLayout& layout);
} // namespace coplane
