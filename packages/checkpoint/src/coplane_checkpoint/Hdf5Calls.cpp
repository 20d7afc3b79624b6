#include <coplane_checkpoint/CheckpointFile.hpp>
#include <coplane_checkpoint/detail/Hdf5Calls.hpp>

#include <cstdlib>
#include <hdf5.h>

/// Of the library, but not in its header: takes an id from its list.
extern "C" void* H5I_remove(hid_t id) __attribute__((weak));

namespace coplane::hdf5
{
namespace
{
void select(hid_t space, const Part& part)
{
  if (part.count == 0)
  {
    check(H5Sselect_none(space), "selecting rows");
    return;
  }
  const hsize_t first[2] = {hsize_t(part.first), 0};
  const hsize_t count[2] = {hsize_t(part.count), hsize_t(part.columns)};
  check(H5Sselect_hyperslab(space, H5S_SELECT_SET, first, nullptr, count, nullptr),
        "selecting rows");
}

hid_t memoryOf(const Part& part)
{
  const hsize_t size[2] = {hsize_t(part.count), hsize_t(part.columns)};
  const hid_t space = H5Screate_simple(2, size, nullptr);
  if (part.count == 0)
    H5Sselect_none(space);
  return space;
}

/// What a data set is created with: nothing that depends on the time of day.
hid_t creation()
{
  const hid_t list = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_obj_track_times(list, false);
  H5Pset_fill_time(list, H5D_FILL_TIME_NEVER);
  H5Pset_alloc_time(list, H5D_ALLOC_TIME_EARLY); // tables have their place at once
  return list;
}

/// Closes a file. Where the system's close fails, HDF5 1.10 frees the file but keeps its id, and
/// frees it again at its end, in MPI_Finalize: then it must forget the id.
herr_t closeFile(hid_t id)
{
  const herr_t status = H5Fclose(id);
  if (status < 0 && H5I_remove)
    H5I_remove(id);
  return status;
}
} // namespace

File::File(const std::string& file, Mode mode)
{
  // Whole files are written beside their names and renamed: locks guard nothing, and some file
  // systems of clusters have none.
  ::setenv("HDF5_USE_FILE_LOCKING", "FALSE", 0);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); // failures become messages of ours
  const Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "opening the file");
  check(H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST), "opening the file");
  if (mode == Mode::Create)
  {
    const Id list(H5Pcreate(H5P_FILE_CREATE), H5Pclose, "creating the file");
    check(H5Pset_userblock(list, CheckpointHead::headBytes), "creating the file");
    check(H5Pset_obj_track_times(list, false), "creating the file");
    id_ = H5Fcreate(file.c_str(), H5F_ACC_TRUNC, list, access);
  }
  else
    id_ = H5Fopen(file.c_str(), H5F_ACC_RDONLY, access);
  if (id_ < 0)
    throw Failure(mode == Mode::Create ? "creating the file" : "opening the file");
}

File::~File()
{
  if (id_ >= 0)
    closeFile(id_);
}

void File::close()
{
  const hid_t closing = id_;
  id_ = -1;
  check(closeFile(closing), "closing the file");
}

/// Groups are made one by one, since those that HDF5 makes on the way note the time of day.
void File::makeGroups(const std::string& name)
{
  for (std::size_t at = name.find('/'); at != std::string::npos; at = name.find('/', at + 1))
    if (groups_.insert(name.substr(0, at)).second)
    {
      const Id list(H5Pcreate(H5P_GROUP_CREATE), H5Pclose, "list");
      check(H5Pset_obj_track_times(list, false), "list");
      const Id group(H5Gcreate2(id_, name.substr(0, at).c_str(), H5P_DEFAULT, list, H5P_DEFAULT),
                     H5Gclose, "creating a group");
    }
}

std::int64_t File::makeSet(const std::string& name, std::int64_t rows, std::int64_t columns,
                           std::int64_t type)
{
  makeGroups(name);
  const hsize_t size[2] = {hsize_t(rows), hsize_t(columns)};
  const Id space(H5Screate_simple(2, size, nullptr), H5Sclose, "shape of the data");
  const Id list(creation(), H5Pclose, "list");
  return H5Dcreate2(id_, name.c_str(), type, space, H5P_DEFAULT, list, H5P_DEFAULT);
}

std::uint64_t File::makeTable(const std::string& name, std::int64_t rows, std::int64_t columns,
                              bool ofIds)
{
  const Id set(makeSet(name, rows, columns, ofIds ? H5T_NATIVE_INT64 : H5T_NATIVE_DOUBLE), H5Dclose,
               "creating a data set");
  if (rows * columns == 0)
    return 0;
  const haddr_t place = H5Dget_offset(set);
  if (place == HADDR_UNDEF)
    throw Failure("finding the place of a data set");
  return place;
}

void File::writeAll(const std::string& name, std::size_t count, std::int64_t type,
                    const void* values)
{
  const Id set(makeSet(name, std::int64_t(count), 1, type), H5Dclose, "creating a data set");
  if (count > 0)
    check(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), "writing '" + name + "'");
}

void File::write(const std::string& name, const std::vector<Real>& values)
{
  writeAll(name, values.size(), H5T_NATIVE_DOUBLE, values.data());
}

void File::writeText(const std::string& name, const std::string& text)
{
  writeAll(name, text.size(), H5T_NATIVE_CHAR, text.data());
}

bool File::has(const std::string& name) const
{
  for (std::size_t at = name.find('/', 1);; at = name.find('/', at + 1))
  {
    if (H5Lexists(id_, name.substr(0, at).c_str(), H5P_DEFAULT) <= 0)
      return false;
    if (at == std::string::npos)
      return true;
  }
}

Part File::shape(const std::string& name) const
{
  if (!has(name))
    throw Failure("'" + name + "' is missing");
  const Id set(H5Dopen2(id_, name.c_str(), H5P_DEFAULT), H5Dclose, "opening a data set");
  const Id space(H5Dget_space(set), H5Sclose, "shape of the data");
  hsize_t size[2] = {0, 0};
  if (H5Sget_simple_extent_ndims(space) != 2)
    throw Failure("'" + name + "' is no table");
  H5Sget_simple_extent_dims(space, size, nullptr);
  return {std::int64_t(size[0]), std::int64_t(size[1]), 0, 0};
}

void File::readAny(const std::string& name, const Part& part, std::int64_t type, void* values) const
{
  if (part.rows * part.columns == 0)
    return;
  const Id set(H5Dopen2(id_, name.c_str(), H5P_DEFAULT), H5Dclose, "opening a data set");
  const Id space(H5Dget_space(set), H5Sclose, "shape of the data");
  select(space, part);
  const Id memory(memoryOf(part), H5Sclose, "shape of the data");
  check(H5Dread(set, type, memory, space, H5P_DEFAULT, values), "reading '" + name + "'");
}

void File::read(const std::string& name, const Part& part, std::vector<Real>& values) const
{
  values.resize(std::size_t(part.count * part.columns));
  readAny(name, part, H5T_NATIVE_DOUBLE, values.data());
}

void File::read(const std::string& name, const Part& part, std::vector<GlobalId>& values) const
{
  values.resize(std::size_t(part.count * part.columns));
  readAny(name, part, H5T_NATIVE_INT64, values.data());
}

std::string File::readText(const std::string& name) const
{
  Part part = shape(name);
  part.count = part.rows;
  std::string text(std::size_t(part.rows), '\0');
  readAny(name, part, H5T_NATIVE_CHAR, text.data());
  return text;
}
} // namespace coplane::hdf5
