#include <coplane_checkpoint/CheckpointFile.hpp>
#include <coplane_checkpoint/Hdf5Calls.hpp>

#include <hdf5.h>

namespace coplane::hdf5
{
namespace
{
/// Closes an id at the end of its scope.
class Id
{
public:
  Id(hid_t id, herr_t (*close)(hid_t), const char* what) : id_(id), close_(close)
  {
    if (id_ < 0)
      throw Failure(what);
  }
  ~Id() { close_(id_); }
  Id(const Id&) = delete;
  Id& operator=(const Id&) = delete;
  operator hid_t() const { return id_; }

private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

void check(herr_t status, const std::string& what)
{
  if (status < 0)
    throw Failure(what);
}

/// All ranks read or write their parts in one call.
hid_t together()
{
  const hid_t list = H5Pcreate(H5P_DATASET_XFER);
  H5Pset_dxpl_mpio(list, H5FD_MPIO_COLLECTIVE);
  return list;
}

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

hid_t spaceOf(const Part& part)
{
  const hsize_t size[2] = {hsize_t(part.rows), hsize_t(part.columns)};
  return H5Screate_simple(2, size, nullptr);
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
  return list;
}

} // namespace

File::File(const std::string& file, Mode mode, const Comm& comm) : comm_(&comm)
{
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); // failures become messages of ours
  const Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "opening the file");
  check(H5Pset_fapl_mpio(access, comm.mpi(), MPI_INFO_NULL), "opening the file on all ranks");
  check(H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST), "opening the file");
  check(H5Pset_all_coll_metadata_ops(access, true), "opening the file");
  check(H5Pset_coll_metadata_write(access, true), "opening the file");
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
    H5Fclose(id_);
}

void File::close()
{
  const hid_t closing = id_;
  id_ = -1;
  check(H5Fclose(closing), "closing the file");
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

void File::writeAny(const std::string& name, const Part& part, std::int64_t type,
                    const void* values)
{
  makeGroups(name);
  const Id space(spaceOf(part), H5Sclose, "shape of the data"), list(creation(), H5Pclose, "list");
  const Id set(H5Dcreate2(id_, name.c_str(), type, space, H5P_DEFAULT, list, H5P_DEFAULT), H5Dclose,
               "creating a data set");
  if (part.rows * part.columns == 0)
    return;
  select(space, part);
  const Id memory(memoryOf(part), H5Sclose, "shape of the data"), all(together(), H5Pclose, "list");
  check(H5Dwrite(set, type, memory, space, all, values), "writing '" + name + "'");
}

void File::write(const std::string& name, const Part& part, const std::vector<Real>& values)
{
  writeAny(name, part, H5T_NATIVE_DOUBLE, values.data());
}

void File::write(const std::string& name, const Part& part, const std::vector<GlobalId>& values)
{
  static_assert(sizeof(GlobalId) == 8);
  writeAny(name, part, H5T_NATIVE_INT64, values.data());
}

void File::writeText(const std::string& name, const std::string& text)
{
  const Part part{std::int64_t(text.size()), 1, 0, comm_->isRoot() ? std::int64_t(text.size()) : 0};
  writeAny(name, part, H5T_NATIVE_CHAR, text.data());
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
  const Id memory(memoryOf(part), H5Sclose, "shape of the data"), all(together(), H5Pclose, "list");
  check(H5Dread(set, type, memory, space, all, values), "reading '" + name + "'");
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
