#include <coplane_checkpoint/Hdf5Guard.hpp>
#include <coplane_core/PlacesOfFile.hpp>
#include <coplane_output/detail/VtkHdfFile.hpp>

#include <algorithm>
#include <cstdlib>
#include <hdf5.h>

namespace coplane
{
namespace
{
using hdf5::check;
using hdf5::Id;

/// Groups, tables and attributes below one group; nothing depends on the time of day.
class Maker
{
public:
  explicit Maker(const std::string& file)
      : access_(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "list"),
        creation_(H5Pcreate(H5P_FILE_CREATE), H5Pclose, "list"),
        file_(create(file), H5Fclose, "creating " + file)
  {
  }

  void group(const std::string& name)
  {
    const Id list(H5Pcreate(H5P_GROUP_CREATE), H5Pclose, "list");
    check(H5Pset_obj_track_times(list, false), "list");
    const Id made(H5Gcreate2(file_, name.c_str(), H5P_DEFAULT, list, H5P_DEFAULT), H5Gclose, name);
  }

  /// A table with a place; returns it. `chunk` > 0: a table that may grow to so many rows.
  std::uint64_t table(const std::string& name, hid_t type, std::int64_t rows, int columns,
                      std::int64_t chunk = 0)
  {
    const int rank = columns > 1 ? 2 : 1;
    const hsize_t size[2] = {hsize_t(rows), hsize_t(columns)}, most[2] = {H5S_UNLIMITED, size[1]},
                  piece[2] = {hsize_t(chunk), size[1]};
    const Id list(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "list");
    check(H5Pset_obj_track_times(list, false), name);
    check(H5Pset_fill_time(list, H5D_FILL_TIME_NEVER), name);
    if (chunk > 0)
      check(H5Pset_chunk(list, rank, piece), name);
    check(H5Pset_alloc_time(list, H5D_ALLOC_TIME_EARLY), name);
    const Id space(H5Screate_simple(rank, size, chunk > 0 ? most : nullptr), H5Sclose, name);
    const Id set(H5Dcreate2(file_, name.c_str(), type, space, H5P_DEFAULT, list, H5P_DEFAULT),
                 H5Dclose, name);
    haddr_t place = 0;
    hsize_t bytes = 0, first[2] = {0, 0};
    if (rows > 0 && chunk > 0)
      check(H5Dget_chunk_info_by_coord(set, first, nullptr, &place, &bytes), name);
    else if (rows > 0)
      place = H5Dget_offset(set);
    if (place == HADDR_UNDEF)
      throw hdf5::Failure("finding the place of " + name);
    return place;
  }

  /// Texts of any lengths (UTF-8), said to be ASCII: VTK reads no others.
  void texts(const std::string& name, const std::vector<std::string>& values)
  {
    const Id type(H5Tcopy(H5T_C_S1), H5Tclose, name);
    check(H5Tset_size(type, H5T_VARIABLE), name);
    std::vector<const char*> pointers;
    for (const std::string& value : values)
      pointers.push_back(value.c_str());
    const hsize_t size = values.size();
    const Id list(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "list");
    check(H5Pset_obj_track_times(list, false), name);
    const Id space(H5Screate_simple(1, &size, nullptr), H5Sclose, name);
    const Id set(H5Dcreate2(file_, name.c_str(), type, space, H5P_DEFAULT, list, H5P_DEFAULT),
                 H5Dclose, name);
    if (!values.empty())
      check(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, pointers.data()), name);
  }

  void link(const std::string& name, const std::string& other)
  {
    check(H5Lcreate_hard(file_, other.c_str(), file_, name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
          name);
  }

  void attribute(const std::string& group, const char* name, std::vector<std::int64_t> values)
  {
    const hsize_t count = values.size();
    const Id space(count == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &count, nullptr),
                   H5Sclose, name);
    write(group, name, H5T_NATIVE_INT64, space, values.data());
  }

  void textAttribute(const std::string& group, const char* name, const std::string& text)
  {
    const Id space(H5Screate(H5S_SCALAR), H5Sclose, name);
    const Id type(H5Tcopy(H5T_C_S1), H5Tclose, name);
    check(H5Tset_size(type, text.size()), name);
    check(H5Tset_strpad(type, H5T_STR_NULLPAD), name);
    write(group, name, type, space, text.data());
  }

private:
  hid_t create(const std::string& file)
  {
    // The oldest format, which every reader of HDF5 knows.
    check(H5Pset_libver_bounds(access_, H5F_LIBVER_EARLIEST, H5F_LIBVER_LATEST), "list");
    check(H5Pset_obj_track_times(creation_, false), "list");
    return H5Fcreate(file.c_str(), H5F_ACC_TRUNC, creation_, access_);
  }

  void write(const std::string& group, const char* name, hid_t type, hid_t space, const void* value)
  {
    const Id where(H5Gopen2(file_, group.c_str(), H5P_DEFAULT), H5Gclose, group);
    const Id made(H5Acreate2(where, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, name);
    check(H5Awrite(made, type, value), name);
  }

  Id access_, creation_, file_;
};

/// What the steps and vertices need.
std::map<std::string, std::uint64_t> makeGrid(Maker& maker, const std::string& writer,
                                              const VtkHdfRoom& room, std::int64_t steps)
{
  std::map<std::string, std::uint64_t> places;
  const std::string top = "/VTKHDF/";
  const auto table = [&](const std::string& name, hid_t type, std::int64_t rows, int columns)
  { places[name] = maker.table(top + name, type, rows, columns); };
  maker.group("/VTKHDF");
  maker.attribute("/VTKHDF", "Version", {2, 0});
  maker.textAttribute("/VTKHDF", "Type", "UnstructuredGrid");
  maker.textAttribute("/VTKHDF", "Writer", writer);
  // The attribute comes to lie before the table of the times: a step is there with the attribute.
  maker.group("/VTKHDF/Steps");
  maker.attribute("/VTKHDF/Steps", "NSteps", {steps});
  places["Steps/Values"] =
      maker.table(top + "Steps/Values", H5T_NATIVE_DOUBLE, steps, 1, room.steps);
  for (const char* name :
       {"NumberOfPoints", "Steps/PointOffsets", "Steps/PartOffsets", "Steps/NumberOfParts"})
    table(name, H5T_NATIVE_INT64, room.steps, 1);
  // Vertices: as many cells and corners as points.
  for (const char* name : {"NumberOfCells", "NumberOfConnectivityIds"})
    maker.link(top + name, top + "NumberOfPoints");
  for (const char* name : {"Steps/CellOffsets", "Steps/ConnectivityIdOffsets"})
    maker.link(top + name, top + "Steps/PointOffsets");
  table("Points", H5T_NATIVE_DOUBLE, room.rows, 3);
  table("Connectivity", H5T_NATIVE_INT64, room.rows, 1);
  table("Offsets", H5T_NATIVE_INT64, room.rows + room.steps, 1);
  table("Types", H5T_NATIVE_UINT8, room.rows, 1);
  return places;
}
} // namespace

VtkHdfSkeleton vtkHdfSkeleton(const std::string& writer, const std::vector<PlaneColumn>& columns,
                              const std::vector<std::string>& joints, const VtkHdfRoom& room,
                              std::int64_t steps)
{
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); // failures become messages of ours
  ::setenv("HDF5_USE_FILE_LOCKING", "FALSE", 0);
  MemoryFile memory;
  VtkHdfSkeleton skeleton;
  {
    Maker maker(memory.name());
    skeleton.places = makeGrid(maker, writer, room, steps);
    maker.group("/VTKHDF/PointData");
    maker.group("/VTKHDF/Steps/PointDataOffsets");
    for (const PlaneColumn& column : columns)
    {
      const std::string name = "PointData/" + column.name;
      const hid_t type = column.values.index() == 0 ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT64;
      skeleton.places[name] = maker.table("/VTKHDF/" + name, type, room.rows, column.components);
      maker.link("/VTKHDF/Steps/PointDataOffsets/" + column.name, "/VTKHDF/Steps/PointOffsets");
    }
    maker.group("/VTKHDF/FieldData");
    maker.texts("/VTKHDF/FieldData/joint_names", joints);
  }
  skeleton.bytes = std::uint64_t(memory.size());
  memory.forEachPiece([&](std::uint64_t at, const char* bytes, std::size_t count)
                      { skeleton.pieces.emplace_back(at, std::string(bytes, count)); });
  return skeleton;
}
} // namespace coplane
