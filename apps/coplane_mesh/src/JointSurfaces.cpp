#include "JointSurfaces.hpp"

#include "FractureFile.hpp"
#include "ShapeModel.hpp"

#include <coplane_core/Error.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace coplane
{
Draws::Draws(int seed, int stream)
{
  std::seed_seq sequence{seed, stream};
  engine_.seed(sequence);
}

Real Draws::uniform()
{
  return Real(engine_() >> 11) * 0x1p-53;
}

Real Draws::normal()
{
  // Box and Muller 1958.
  const Real radius = std::sqrt(-2 * std::log(1 - uniform()));
  return radius * std::cos(2 * pi * uniform());
}

Vec3 normalOfDip(Real dip, Real dipDirection, const Vec3& up, const Vec3& north)
{
  const Vec3 above = normalised(up), ahead = normalised(north - dot(north, above) * above);
  const Vec3 right = cross(ahead, above);
  const Real azimuth = dipDirection * pi / 180, descent = dip * pi / 180;
  const Vec3 down = std::cos(azimuth) * ahead + std::sin(azimuth) * right;
  return std::sin(descent) * down + std::cos(descent) * above;
}

namespace
{
/// Two unit vectors that make a right-handed frame with `normal`.
std::pair<Vec3, Vec3> axesOf(const Vec3& normal)
{
  Vec3 axis{};
  axis[std::abs(normal.x) < 0.6 ? 0 : 1] = 1;
  const Vec3 u = normalised(axis - dot(axis, normal) * normal);
  return {u, cross(normal, u)};
}

/// A normal drawn round `mean` by Fisher's distribution: cos(angle) has a density proportional to
/// exp(K cos(angle)).
Vec3 fisherNormal(const Vec3& mean, Real concentration, Draws& draws)
{
  const Real cosine =
      1 + std::log(1 - draws.uniform() * (1 - std::exp(-2 * concentration))) / concentration;
  const Real sine = std::sqrt(std::max(0.0, 1 - cosine * cosine)), turn = 2 * pi * draws.uniform();
  const auto [u, v] = axesOf(mean);
  return cosine * mean + sine * (std::cos(turn) * u + std::sin(turn) * v);
}

/// A polygon of 24 corners with the area of the circle.
std::vector<Vec3> discOf(const Vec3& centre, const Vec3& normal, Real radius)
{
  constexpr int count = 24;
  const auto [u, v] = axesOf(normal);
  const Real reach = radius * std::sqrt(2 * pi / (count * std::sin(2 * pi / count)));
  std::vector<Vec3> corners;
  for (int k = 0; k < count; ++k)
    corners.push_back(
        centre + reach * (std::cos(2 * pi * k / count) * u + std::sin(2 * pi * k / count) * v));
  return corners;
}

/// The surfaces of one joint.
class JointMaker
{
public:
  JointMaker(const BlocksRecipe& recipe, int joint, const Vec3& low, const Vec3& high,
             std::vector<JointSurface>& surfaces)
      : recipe_(recipe), joint_(joint), middle_(0.5 * (low + high)), reach_(norm(high - low)),
        surfaces_(surfaces), draws_(recipe.seed, joint)
  {
  }

  void makeSet(const JointSetCard& set)
  {
    const bool flat = recipe_.dimension == 2;
    const Real angle = set.angle * pi / 180;
    const Vec3 mean = flat ? Vec3{-std::sin(angle), std::cos(angle), 0}
                           : normalOfDip(set.dip, set.dipDirection, recipe_.up, recipe_.north);
    const Vec3 through = set.through.empty() ? middle_ : toVec3(set.through);
    for (const Real offset : offsets(set, dot(middle_ - through, mean)))
    {
      Vec3 normal = mean;
      if (flat && set.angleScatter > 0)
      {
        const Real turned = angle + set.angleScatter * pi / 180 * draws_.normal();
        normal = {-std::sin(turned), std::cos(turned), 0};
      }
      else if (!flat && set.fisher > 0)
        normal = fisherNormal(mean, set.fisher, draws_);
      // Below or above the middle of the domain, so that scatter turns a joint about its middle.
      const Vec3 foot = middle_ + (dot(through - middle_, mean) + offset) * mean;
      if (set.persistence < 1)
        addParts(foot, normal, set);
      else
        addPlane(foot, normal);
    }
  }

  /// How many surfaces or steps makeSet would need.
  Real workOfSet(const JointSetCard& set) const
  {
    const Vec3 through = set.through.empty() ? middle_ : toVec3(set.through);
    const Real parts = set.persistence < 1 ? std::ceil(2 * reach_ / set.length) : 1;
    return (reach_ + norm(through - middle_)) / set.spacing *
           std::pow(parts, recipe_.dimension - 1);
  }

  void makePlanes(const JointPlaneCard& card)
  {
    const Vec3 normal = normalised(toVec3(card.normal));
    const auto number = &card - recipe_.joints[std::size_t(joint_)].planes.data() + 1;
    for (int k = 0; k < card.count; ++k)
    {
      source_ = fmt::format("plane {}", number);
      if (card.count > 1)
        source_ += fmt::format(" ({} of {})", k + 1, card.count);
      const Vec3 shift = k * card.spacing * normal, point = toVec3(card.point) + shift;
      const auto onPlane = [&](const Vec3& x) { return x - dot(x - point, normal) * normal; };
      if (card.disc.radius > 0)
        add(discOf(onPlane(toVec3(card.disc.centre)), normal, card.disc.radius));
      else if (!card.segment.empty())
        add({onPlane(toVec3(card.segment[0])), onPlane(toVec3(card.segment[1]))});
      else if (!card.polygon.empty())
      {
        std::vector<Vec3> corners;
        for (const Vec3& corner : toPoints(card.polygon))
          corners.push_back(onPlane(corner));
        add(corners);
      }
      else
        addPlane(onPlane(middle_), normal);
    }
  }

  void makeFracture(const Fracture& fracture)
  {
    const auto& values = fracture.values;
    const auto at = [&](const char* name) { return values.at(name); };
    source_ = fmt::format("line {}", fracture.line);
    if (!fracture.corners.empty())
      return add(fracture.corners);
    if (recipe_.dimension == 2)
      return add({{at("x1"), at("y1"), 0}, {at("x2"), at("y2"), 0}});
    const Vec3 normal =
        values.count("nx") ? normalised(Vec3{at("nx"), at("ny"), at("nz")})
                           : normalOfDip(at("dip"), at("dip_direction"), recipe_.up, recipe_.north);
    add(discOf({at("x"), at("y"), at("z")}, normal, at("radius")));
  }

private:
  /// Distances along the normal from the point that the set goes through; all planes that can meet
  /// the domain. @param middle the same of the middle of the domain
  std::vector<Real> offsets(const JointSetCard& set, Real middle)
  {
    std::vector<Real> all;
    const auto gap = [&]
    { return set.spacing * (1 + set.spacingScatter * (2 * draws_.uniform() - 1)); };
    for (Real offset = 0; offset < middle + reach_ / 2; offset += gap())
      if (offset > middle - reach_ / 2)
        all.push_back(offset);
    for (Real offset = -gap(); offset > middle - reach_ / 2; offset -= gap())
      if (offset < middle + reach_ / 2)
        all.push_back(offset);
    std::sort(all.begin(), all.end());
    return all;
  }

  void add(const std::vector<Vec3>& corners) { surfaces_.push_back({joint_, corners, source_}); }

  /// Beyond the domain to all sides.
  void addPlane(const Vec3& point, const Vec3& normal)
  {
    if (recipe_.dimension == 2)
    {
      const Vec3 along{normal.y, -normal.x, 0};
      return add({point - reach_ * along, point + reach_ * along});
    }
    const auto [u, v] = axesOf(normal);
    add({point - reach_ * u - reach_ * v, point + reach_ * u - reach_ * v,
         point + reach_ * u + reach_ * v, point - reach_ * u + reach_ * v});
  }

  /// Parts of the length of the set between bridges, on a grid that starts anywhere; in three
  /// dimensions squares, two of their sides along the strike.
  void addParts(const Vec3& point, const Vec3& normal, const JointSetCard& set)
  {
    const Real half = set.length / 2;
    const auto starts = [&](Real period)
    {
      std::vector<Real> middles;
      for (Real s = -reach_ + period * draws_.uniform(); s < reach_; s += period)
        middles.push_back(s);
      return middles;
    };
    if (recipe_.dimension == 2)
    {
      const Vec3 along{normal.y, -normal.x, 0};
      for (const Real s : starts(set.length / set.persistence))
        add({point + (s - half) * along, point + (s + half) * along});
      return;
    }
    const Vec3 strike = cross(recipe_.up, normal);
    const Vec3 u =
        norm(strike) > 1e-9 * norm(recipe_.up) ? normalised(strike) : axesOf(normal).first;
    const Vec3 v = cross(normal, u);
    const Real period = set.length / std::sqrt(set.persistence);
    const std::vector<Real> columns = starts(period), rows = starts(period);
    for (const Real s : columns)
      for (const Real t : rows)
        if (s * s + t * t < std::pow(reach_ / 2 + set.length, 2))
          add({point + (s - half) * u + (t - half) * v, point + (s + half) * u + (t - half) * v,
               point + (s + half) * u + (t + half) * v, point + (s - half) * u + (t + half) * v});
  }

  const BlocksRecipe& recipe_;
  int joint_;
  Vec3 middle_;
  Real reach_; ///< the diagonal of the domain's box [m]
  std::vector<JointSurface>& surfaces_;
  std::string source_;
  Draws draws_;
};
} // namespace

std::vector<JointSurface> jointSurfaces(const BlocksRecipe& recipe, const std::string& recipeFile,
                                        const Vec3& low, const Vec3& high, Problems& problems)
{
  std::vector<JointSurface> surfaces;
  for (std::size_t j = 0; j < recipe.joints.size(); ++j)
  {
    const JointsCard& card = recipe.joints[j];
    JointMaker maker(recipe, int(j), low, high, surfaces);
    if (card.set.spacing > 0)
    {
      constexpr Real most = 1e6;
      if (const Real work = maker.workOfSet(card.set); work > most)
        problems.add(nodeAt(recipe.root, {"joints", card.name, "set"}),
                     fmt::format("joints.{}.set makes about {:.2g} joints, and up to {:.2g} are "
                                 "made: spacing or length is too small for the domain, or "
                                 "through too far away.",
                                 card.name, work, most));
      else
        maker.makeSet(card.set);
    }
    for (const JointPlaneCard& plane : card.planes)
      maker.makePlanes(plane);
    if (card.file.empty())
      continue;
    try
    {
      const auto file = std::filesystem::path(recipeFile).parent_path() / card.file;
      for (const auto& row : readFractures(file.string(), recipe.dimension))
        maker.makeFracture(row);
    }
    catch (const Error& error)
    {
      problems.add(nodeAt(recipe.root, {"joints", card.name, "file"}), error.what());
    }
  }
  return surfaces;
}
} // namespace coplane
