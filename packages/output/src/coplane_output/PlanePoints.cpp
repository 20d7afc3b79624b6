#include <coplane_contact/ContactTables.hpp>
#include <coplane_contact/PlaneState.hpp>
#include <coplane_mesh/ElementTopology.hpp>
#include <coplane_output/detail/PlanePoints.hpp>

#include <algorithm>

namespace coplane
{
namespace
{
/// What of a plane goes to the file.
struct Record
{
  Plane plane;
  GlobalId block[2];
  Real damage;
};

/// This rank's planes, sent to rank 0 and sorted by key there.
std::vector<Record> gatherRecords(const Solver& solver)
{
  std::vector<std::vector<Record>> toRank(solver.comm().size());
  if (solver.hasContact())
  {
    const Contact& contact = solver.contact();
    const auto& blocks = solver.mesh().blocks;
    for (std::size_t p = 0; p < contact.planesNow().size(); ++p)
    {
      const Plane& plane = contact.planesNow()[p];
      if (!contact.isWrittenHere(plane) || !(plane.overlap > 0))
        continue;
      const JointLaw& law = contact.lawOf(plane);
      toRank[0].push_back({planeNow(contact, plane, solver.state().x),
                           {blocks[plane.block[0]].id, blocks[plane.block[1]].id},
                           law.damage(plane.history)});
    }
  }
  std::vector<Record> records = solver.comm().exchange(toRank);
  std::sort(records.begin(), records.end(),
            [](const Record& a, const Record& b) { return keyLess(a.plane, b.plane); });
  return records;
}

/// The columns of a file, each from what `of` takes from a record.
class Columns
{
public:
  Columns(PlanePoints& points, const std::vector<Record>& records)
      : points_(points), records_(records)
  {
  }
  template <class F>
  void vector(const std::string& name, const F& of)
  {
    std::vector<Real> values;
    for (const Record& record : records_)
      for (int c = 0; c < 3; ++c)
        values.push_back(of(record)[c]);
    points_.columns.push_back({name, 3, std::move(values)});
  }
  template <class F>
  void scalar(const std::string& name, const F& of)
  {
    std::vector<Real> values;
    for (const Record& record : records_)
      values.push_back(of(record));
    points_.columns.push_back({name, 1, std::move(values)});
  }
  template <class F>
  void integer(const std::string& name, const F& of)
  {
    std::vector<std::int64_t> values;
    for (const Record& record : records_)
      values.push_back(std::int64_t(of(record)));
    points_.columns.push_back({name, 1, std::move(values)});
  }

private:
  PlanePoints& points_;
  const std::vector<Record>& records_;
};

/// The columns that are members of the planes.
void addMembers(Columns& columns)
{
  forEachMember(
      [&](const auto& member)
      {
        if (!member.column)
          return;
        const auto of = [&](const Record& r) -> const auto&
        {
          return member.get(r.plane);
        };
        using Value = std::decay_t<decltype(member.get(std::declval<const Plane&>()))>;
        if constexpr (std::is_same_v<Value, Vec3>)
          columns.vector(member.column, of);
        else if constexpr (std::is_floating_point_v<Value>)
          columns.scalar(member.column, of);
        else if constexpr (std::is_integral_v<Value> || std::is_enum_v<Value>)
          columns.integer(member.column, of);
        else
          fail(ExitCode::Internal, "plane files: no column holds '{}'", member.column);
      });
}

/// Those that follow from them.
void addDerived(Columns& columns)
{
  columns.vector("force", [](const Record& r) { return r.plane.forceOn(1); });
  columns.scalar("gap", [](const Record& r) { return r.plane.gap - r.plane.offset; });
  columns.scalar("damage", [](const Record& r) { return r.damage; });
  columns.scalar("remainder", [](const Record& r) { return r.plane.remainder(); });
  columns.integer("inherited", [](const Record& r) { return r.plane.isInherited(); });
  columns.integer("released", [](const Record& r) { return r.plane.isReleased(); });
  for (int f = 0; f < 2; ++f)
  {
    const std::string which = f == 0 ? "lower" : "higher";
    columns.integer(which + "_block", [f](const Record& r) { return r.block[f]; });
    columns.integer(which + "_element",
                    [f](const Record& r) { return elementOfFace(r.plane.faceId[f]); });
    columns.integer(which + "_side",
                    [f](const Record& r) { return sideOfFace(r.plane.faceId[f]) + 1; });
  }
}

PlanePoints pointsOf(const std::vector<Record>& records)
{
  PlanePoints points;
  for (const Record& record : records)
    for (int c = 0; c < 3; ++c)
      points.coordinates.push_back(record.plane.pointOfContact[c]);
  Columns columns(points, records);
  addMembers(columns);
  addDerived(columns);
  return points;
}
} // namespace

PlanePoints planePointsOf(const Solver& solver)
{
  return pointsOf(gatherRecords(solver));
}

PlanePoints planePointsOfNone()
{
  return pointsOf({});
}

std::vector<std::string> jointNames(const Solver& solver)
{
  std::vector<std::string> names;
  if (solver.hasContact())
    for (const JointRecipe& joint : solver.contact().rules().joints)
      names.push_back(joint.name);
  return names;
}
} // namespace coplane
