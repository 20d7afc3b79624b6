#include <coplane_contact/detail/EdgesOfSurfaces.hpp>
#include <coplane_contact/detail/View.hpp>

#include <algorithm>
#include <cmath>

namespace coplane
{
namespace
{
/// Edges bound a strip if on the common plane they face away from each other at least so much [-],
/// minus the cosine, and in space have at least so much of their directions in common. Edges that
/// cross bound none, as bodies on them cannot leave each other sideways; unless the surfaces beyond
/// them oppose each other and the faces do much less, like the ends of two bricks beside each
/// other, and the top of one and the front of the other: the ends keep them apart.
constexpr Real faceAway = 0.5, parallel = 0.97, muchLess = 0.3;
/// A face that lies so deep behind another one, over the thinner element, is a back [-].
constexpr Real deepBehind = 0.5;
/// Bodies can leave each other over an edge at which the normal beyond has less than this in common
/// with the face's.
constexpr Real sharp = 0.4;
/// Faces lie on each other if they share more than this fraction of the smaller one.
constexpr Real leastShare = 0.2;
/// A surface turns outwards at an edge if its normal beyond has more than this in the outward
/// direction; reentrant edges do not count.
constexpr Real convex = 0.1;
/// Edges run along each other if their outward directions have more than this in common [-].
constexpr Real sameWay = 0.7;

/// Area that the boxes around two shadows share: what the shadows share is not larger [m^2].
Real sharedByBoxes(const ConvexPolygon& a, const ConvexPolygon& b)
{
  Box boxes[2];
  for (const auto& [box, shadow] : {std::pair(&boxes[0], &a), std::pair(&boxes[1], &b)})
    for (int i = 0; i < shadow->size; ++i)
      box->include(Vec3{shadow->vertex[i].x, shadow->vertex[i].y, 0});
  const auto shared = [&](int axis)
  {
    return std::max(0.0, std::min(boxes[0].high[axis], boxes[1].high[axis]) -
                             std::max(boxes[0].low[axis], boxes[1].low[axis]));
  };
  return shared(0) * shared(1);
}
} // namespace

/// Edge e of a face, in the order of its nodes.
EdgesOfSurfaces::Edge EdgesOfSurfaces::lookBeyond(const Face& face, int e, const Vec3& normal,
                                                  const std::vector<Mirror>& mirrors) const
{
  Edge edge{};
  const int next = dimension_ == 2 ? e : e + 1 == face.count ? 0 : e + 1;
  if (dimension_ == 2) // the "edge" is node e
  {
    edge.nodes[0] = edge.nodes[1] = face.nodes[e];
    edge.outward = normalised(at(x_, face.nodes[e]) - at(x_, face.nodes[1 - e]));
  }
  else
  {
    edge.nodes[0] = face.nodes[e];
    edge.nodes[1] = face.nodes[next];
    edge.outward = normalised(cross(at(x_, edge.nodes[1]) - at(x_, edge.nodes[0]), normal));
  }
  // The surface beyond is the face that both nodes have beside this one, the sharpest turn if there
  // are two. Beyond an edge that lies in a mirror it is the image of the face.
  Real least = DirectionsOfNodes::one;
  const auto take = [&](const Vec3& other)
  {
    if (!(dot(other, edge.outward) > convex && dot(other, normal) < least))
      return;
    edge.turns = true;
    edge.beyond = other;
    least = dot(other, normal);
  };
  for (int i = 0; i < normals_.most(); ++i)
  {
    const Vec3 other = normals_.normal(edge.nodes[0], i);
    if (normals_.has(edge.nodes[1], other))
      take(other);
  }
  for (std::size_t m = 0; m < mirrors.size(); ++m)
    if ((face.mirrors[e] & face.mirrors[next]) >> m & 1)
      take(mirrors[m].reflected(normal));
  return edge;
}

EdgesOfSurfaces::EdgesOfSurfaces(const std::vector<CandidatePair>& pairs, const Array<Face>& faces,
                                 std::size_t localFaces, const Array<FacePlane>& planes,
                                 const ConstNodeVectors& x, int dimension,
                                 const std::vector<Mirror>& mirrors, const NodeLayout& layout)
    : pairs_(pairs), faces_(faces), planes_(planes), x_(x), dimension_(dimension),
      lieOn_(pairs.size()), normals_(layout.size()), hidden_(layout.size()), flush_(layout.size()),
      goingOn_(layout.size())
{
  for (std::size_t f = 0; f < localFaces; ++f)
    if (!faces[f].isCut())
      for (int k = 0; k < faces[f].count; ++k)
        if (faces[f].nodes[k] < layout.owned())
          normals_.add(faces[f].nodes[k], planes(f).normal);
  normals_.refresh(layout);
  findEdges(mirrors);
  normals_ = NormalsOfNodes(0); // nobody asks any more, and there may be many
  parallelFor("coplane::contact::lieOn", int(pairs.size()),
              [&](const int p) { lieOn_[p] = lieOn(pairs[p].lower, pairs[p].higher); });
  findHidden(layout);
}

void EdgesOfSurfaces::findEdges(const std::vector<Mirror>& mirrors)
{
  firstEdge_.assign(faces_.extent(0), -1);
  std::vector<std::int32_t> paired;
  std::int32_t count = 0;
  for (const CandidatePair& pair : pairs_)
    for (const int face : {pair.lower, pair.higher})
      if (firstEdge_[face] < 0)
      {
        firstEdge_[face] = count;
        count += faces_[face].count;
        paired.push_back(face);
      }
  edges_.resize(count);
  parallelFor("coplane::contact::findEdges", int(paired.size()),
              [&](const int i)
              {
                const std::int32_t f = paired[i];
                for (int e = 0; e < faces_[f].count; ++e)
                  edges_[firstEdge_[f] + e] = lookBeyond(faces_[f], e, planes_(f).normal, mirrors);
              });
}

const EdgesOfSurfaces::Edge& EdgesOfSurfaces::edge(int face, int side, int e) const
{
  // The outline of the higher face runs the other way.
  const int count = faces_[face].count;
  const int own = side == 0 || dimension_ == 2 ? e : e + 1 == count ? count - 1 : count - 2 - e;
  return edges_[firstEdge_[face] + own];
}

int EdgesOfSurfaces::hides(const int (&nodes)[2], const Vec3& normal, const Vec3& beyond,
                           const DirectionsOfNodes& ends) const
{
  const Vec3 outward = normalised(beyond - dot(beyond, normal) * normal);
  int bodies[2];
  for (int end = 0; end < 2; ++end)
  {
    const int place = hidden_.find(nodes[end], normal);
    if (place < 0 || ends.find(nodes[end], outward) < 0)
      return -1;
    bodies[end] = hidden_.number(nodes[end], place);
  }
  return bodies[0] == bodies[1] ? bodies[0] : -1; // two may have a gap between them
}

Real EdgesOfSurfaces::lieOn(int lower, int higher) const
{
  const Face &a = faces_[lower], &b = faces_[higher];
  const FacePlane &planeA = planes_(lower), &planeB = planes_(higher);
  if (!(dot(planeA.normal, planeB.normal) < -DirectionsOfNodes::one))
    return 0;
  const Vec3 normal = normalised(planeA.normal - planeB.normal);
  const View view(normal, at(x_, a.nodes[0]), dimension_);
  ConvexPolygon shadows[2];
  Vec3 centers[2];
  for (int f = 0; f < 2; ++f)
  {
    const FaceCorners corners = cornersAt(x_, f == 0 ? a : b);
    centers[f] = corners.center();
    shadows[f] = view.shadow(corners.x, corners.count);
  }
  const Real smaller = std::min(areaAndCentroid(shadows[0]).area, areaAndCentroid(shadows[1]).area);
  const Real size = faceSize(smaller, dimension_);
  const Real gap = dot(normal, centers[1] - centers[0]);
  // Most pairs are edge neighbours, which share next to nothing: their boxes tell. The factor is
  // more than any round-off.
  const bool near =
      gap < flush * size && gap > -std::min(a.thickness, b.thickness) &&
      2 * sharedByBoxes(shadows[0], shadows[1]) > leastShare * smaller &&
      areaAndCentroid(intersection(shadows[0], shadows[1])).area > leastShare * smaller;
  return near ? size : 0;
}

void EdgesOfSurfaces::findHidden(const NodeLayout& layout)
{
  for (std::size_t p = 0; p < pairs_.size(); ++p)
  {
    const Real size = lieOn_[p];
    if (!(size > 0))
      continue;
    const int places[2] = {pairs_[p].lower, pairs_[p].higher};
    const Face* const both[2] = {&faces_[places[0]], &faces_[places[1]]};
    for (int e = 0; e < both[0]->count; ++e)
    {
      const Edge& mine = edge(places[0], 0, e);
      for (int o = 0; o < both[1]->count && mine.turns; ++o)
      {
        const Edge& its = edge(places[1], 1, o);
        if (!its.turns || !(dot(mine.outward, its.outward) > sameWay))
          continue;
        for (int f = 0; f < 2; ++f)
        {
          const Edge& from = f == 0 ? mine : its;
          const Edge& to = f == 0 ? its : mine;
          const Vec3 along = at(x_, to.nodes[1]) - at(x_, to.nodes[0]);
          for (const int node : {from.nodes[0], from.nodes[1]})
          {
            const Vec3 off = at(x_, node) - at(x_, to.nodes[0]);
            const Real part = dimension_ == 2 ? 0 : dot(off, along) / dot(along, along);
            if (node >= layout.owned() || !(std::abs(dot(off, to.outward)) < flush * size) ||
                !(part > -flush && part < 1 + flush))
              continue;
            hidden_.add(node, planes_(places[f]).normal, both[1 - f]->body);
            flush_.add(node, from.outward, 0);
            if (dot(mine.beyond, its.beyond) > DirectionsOfNodes::one)
              goingOn_.add(node, from.outward, 0);
          }
        }
      }
    }
  }
  hidden_.refresh(layout);
  flush_.refresh(layout);
  goingOn_.refresh(layout);
}

/// What lies beyond one of the edges of a pair.
struct EdgesOfSurfaces::Beyond
{
  const Edge* edge = nullptr; ///< nullptr: the surface does not turn there
  Vec3 outward;               ///< on the common plane
  int covers = -1;            ///< body that lies on the face there, flush at the edge; -1: none
  int goesOn = -1;            ///< body on which the surface goes on over a seam; -1: none
};

/// The edges lie across from each other: bodies on them can leave each other sideways.
bool EdgesOfSurfaces::isWayOut(const Beyond& a, const Beyond& b, const Vec3& normalA,
                               const Vec3& normalB) const
{
  if (!a.edge || !b.edge || !(dot(a.edge->beyond, normalA) < sharp) ||
      !(dot(b.edge->beyond, normalB) < sharp) || !(dot(a.outward, b.outward) < -faceAway))
    return false;
  const Vec3 alongA = cross(a.edge->outward, normalA), alongB = cross(b.edge->outward, normalB);
  return dimension_ == 2 || std::abs(dot(alongA, alongB)) > parallel ||
         (dot(normalA, normalB) > -muchLess &&
          dot(a.edge->beyond, b.edge->beyond) < -DirectionsOfNodes::one);
}

void EdgesOfSurfaces::look(std::size_t pair, Plane& plane) const
{
  const int places[2] = {pairs_[pair].lower, pairs_[pair].higher};
  const Vec3 normals[2] = {planes_(places[0]).normal, planes_(places[1]).normal};
  const Vec3 common = normalised(normals[0] - normals[1]);
  const bool onEachOther = lieOn_[pair] > 0, slanted = dot(normals[0], normals[1]) > -muchLess;
  const bool behind =
      dot(common, planes_(places[1]).center - planes_(places[0]).center) <
      -deepBehind * std::min(faces_[places[0]].thickness, faces_[places[1]].thickness);
  Beyond all[8];
  for (int f = 0; f < 2; ++f)
  {
    const int other = faces_[places[1 - f]].body;
    for (int e = 0; e < faces_[places[f]].count; ++e)
    {
      const Edge& edge = this->edge(places[f], f, e);
      if (!edge.turns)
        continue;
      Beyond& here = all[4 * f + e];
      here.edge = &edge;
      here.outward = normalised(edge.outward - dot(edge.outward, common) * common);
      // Not by the body of the other face: that one comes with what lies there.
      const int covers = onEachOther ? -1 : hides(edge.nodes, normals[f], edge.beyond, flush_);
      here.covers = covers == other ? -1 : covers;
      // A body does not press upon itself past the seam, where it opposes a face just so, or with
      // its back: of two bodies beside each other the top of one and the bottom of the other.
      const int goesOn = hides(edge.nodes, edge.beyond, normals[f], goingOn_);
      here.goesOn = (slanted || behind) && goesOn == other ? -1 : goesOn;
    }
  }
  const auto forEachWayOut = [&](const auto& action)
  {
    for (int e = 0; e < 4; ++e)
      for (int o = 4; o < 8; ++o)
        if (isWayOut(all[e], all[o], normals[0], normals[1]))
          action(e, o);
  };
  // Three bodies around a corner: one lies on both others, which meet at their edges only. The
  // surface goes on both ways there; which one counts, the least way out tells.
  forEachWayOut(
      [&](int e, int o)
      {
        Beyond &a = all[e], &b = all[o];
        if ((a.covers >= 0 && a.covers == b.goesOn) || (b.covers >= 0 && b.covers == a.goesOn))
          a.covers = a.goesOn = b.covers = b.goesOn = -1;
      });
  unsigned turns = 0, exits = 0, covered = 0, seams = 0;
  forEachWayOut(
      [&](int e, int o)
      {
        if (all[e].goesOn < 0 && all[o].goesOn < 0)
          exits |= 1u << e | 1u << o;
      });
  for (int k = 0; k < 8; ++k)
  {
    if (all[k].covers >= 0)
      covered |= 1u << k;
    if (all[k].edge)
      (all[k].goesOn < 0 ? turns : seams) |= 1u << k;
  }
  plane.exits = std::uint8_t(exits);
  plane.turns = std::uint8_t(turns);
  plane.covered = std::uint8_t(covered);
  plane.seams = std::uint8_t(seams);
}
} // namespace coplane
