// Loaded before the program (LD_PRELOAD), this makes one call on one rank fail: an allocation or a
// collective call throws std::bad_alloc, a call of the system returns an error. Counted are calls
// between MPI_Init and MPI_Finalize; of files, those of plain files below the working folder; of
// collectives, those that the program itself makes. A line "FAULT: ..." on stderr says that it
// happened.
//
//   FAULT_KIND   memory, collective, open, read, write, sync, reserve, rename or close
//   FAULT_RANK   the rank on which it fails
//   FAULT_NTH    which call of the kind fails, from 1; 0: none
//   FAULT_LAST   the last one that fails (a disk that stays full); default: only the one
//   FAULT_ERRNO  of calls of the system; default: EIO
//   FAULT_TRACE  set: the stack of the call is printed
//   FAULT_LOG    folder for a file per rank: how many calls of each kind there were, and from where
//   the collective ones came

#include <climits>
#include <mpi.h>

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <execinfo.h>
#include <fcntl.h>
#include <new>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

namespace
{
enum Kind
{
  Memory,
  Collective,
  Open,
  Read,
  Write,
  Sync,
  Reserve,
  Rename,
  Close,
  kinds
};
constexpr const char* names[kinds] = {"memory", "collective", "open",   "read", "write",
                                      "sync",   "reserve",    "rename", "close"};

std::atomic<bool> isOn{false};
std::atomic<long> calls[kinds];
int chosen = -1, errorNumber = EIO;
long first = 0, last = 0;
char here[PATH_MAX];
void* program = nullptr; // where the executable lies
int log_ = -1;
thread_local bool inside = false; // what this library calls itself does not count

struct Inside
{
  Inside() { inside = true; }
  ~Inside() { inside = false; }
};

/// Says once on stderr that it happened, without memory of its own; with FAULT_TRACE, where.
void tell(Kind kind, long call)
{
  static std::atomic<bool> told{false};
  if (told.exchange(true))
    return;
  const Inside guard;
  char text[64];
  const int length = std::snprintf(text, sizeof text, "FAULT: %s %ld\n", names[kind], call);
  if (::write(STDERR_FILENO, text, std::size_t(length)) < 0 || !std::getenv("FAULT_TRACE"))
    return;
  void* frames[40];
  ::backtrace_symbols_fd(frames, ::backtrace(frames, 40), STDERR_FILENO);
}

bool fails(Kind kind)
{
  const long call = ++calls[kind];
  const bool now = chosen == kind && call >= first && call <= last;
  if (now)
    tell(kind, call);
  return now;
}

bool isMine(int descriptor)
{
  if (!isOn || inside)
    return false;
  const Inside guard;
  char link[64], path[PATH_MAX];
  std::snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
  const ssize_t length = ::readlink(link, path, sizeof path - 1);
  const std::size_t prefix = std::strlen(here);
  return length > ssize_t(prefix) && std::strncmp(path, here, prefix) == 0;
}

bool isMine(const char* path)
{
  if (!isOn || inside)
    return false;
  return path[0] != '/' || std::strncmp(path, here, std::strlen(here)) == 0;
}

template <class F>
F* real(const char* name)
{
  const Inside guard;
  return reinterpret_cast<F*>(::dlsym(RTLD_NEXT, name));
}
#define REAL(name) static auto* const theReal = real<decltype(::name)>(#name)

/// A call of the system on a plain file of the run fails.
#define FAIL_IF(kind, mine)                                                                        \
  if (mine && fails(kind))                                                                         \
  {                                                                                                \
    errno = errorNumber;                                                                           \
    return -1;                                                                                     \
  }

void noteCaller()
{
  void* frames[24];
  const int count = ::backtrace(frames, 24);
  char text[24 * 20 + 2];
  int length = 0;
  for (int i = 2; i < count; ++i)
    length += std::snprintf(text + length, 20, "%lx ",
                            long(static_cast<char*>(frames[i]) - static_cast<char*>(program)));
  text[length++] = '\n';
  if (::write(log_, text, std::size_t(length)) < 0)
    std::abort();
}

void collective(void* caller)
{
  if (!isOn || inside)
    return;
  const Inside guard;
  Dl_info from;
  if (!::dladdr(caller, &from) || from.dli_fbase != program)
    return;
  if (log_ >= 0)
    noteCaller();
  if (fails(Collective))
    throw std::bad_alloc();
}
#define COLLECTIVE collective(__builtin_return_address(0))

void* allocate(std::size_t size, std::size_t alignment)
{
  if (isOn && !inside && fails(Memory))
  {
    if (const std::new_handler handler = std::get_new_handler())
      handler();
    throw std::bad_alloc();
  }
  void* memory = nullptr;
  if (alignment <= alignof(max_align_t))
    memory = std::malloc(size ? size : 1);
  else if (::posix_memalign(&memory, alignment, size) != 0)
    memory = nullptr;
  if (!memory)
    throw std::bad_alloc();
  return memory;
}

void start()
{
  const Inside guard;
  int rank = 0;
  PMPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (!::getcwd(here, sizeof here))
    std::abort();
  // The lowest mapping is the program's.
  FILE* const maps = std::fopen("/proc/self/maps", "r");
  unsigned long base = 0;
  if (!maps || std::fscanf(maps, "%lx", &base) != 1)
    std::abort();
  std::fclose(maps);
  program = reinterpret_cast<void*>(base);
  const char* const kind = std::getenv("FAULT_KIND");
  const char* const onRank = std::getenv("FAULT_RANK");
  const char* const nth = std::getenv("FAULT_NTH");
  if (kind && nth && onRank && std::atoi(onRank) == rank)
    for (int k = 0; k < kinds; ++k)
      if (std::strcmp(kind, names[k]) == 0)
        chosen = k;
  first = nth ? std::atol(nth) : 0;
  last = std::getenv("FAULT_LAST") ? std::atol(std::getenv("FAULT_LAST")) : first;
  if (first == 0)
    chosen = -1;
  if (std::getenv("FAULT_ERRNO"))
    errorNumber = std::atoi(std::getenv("FAULT_ERRNO"));
  if (const char* const folder = std::getenv("FAULT_LOG"))
  {
    char file[PATH_MAX];
    std::snprintf(file, sizeof file, "%s/calls.%d", folder, rank);
    log_ = ::open(file, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  }
  isOn = true;
}

void stop()
{
  isOn = false;
  if (log_ < 0)
    return;
  for (int k = 0; k < kinds; ++k)
    ::dprintf(log_, "%s %ld\n", names[k], long(calls[k]));
  ::close(log_);
}
} // namespace

void* operator new(std::size_t size)
{
  return allocate(size, 0);
}
void* operator new[](std::size_t size)
{
  return allocate(size, 0);
}
void* operator new(std::size_t size, std::align_val_t alignment)
{
  return allocate(size, std::size_t(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment)
{
  return allocate(size, std::size_t(alignment));
}
void operator delete(void* memory) noexcept
{
  std::free(memory);
}
void operator delete[](void* memory) noexcept
{
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept
{
  std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept
{
  std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept
{
  std::free(memory);
}
void operator delete[](void* memory, std::align_val_t) noexcept
{
  std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept
{
  std::free(memory);
}
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept
{
  std::free(memory);
}

extern "C"
{
  int MPI_Init(int* argc, char*** argv)
  {
    const int status = PMPI_Init(argc, argv);
    start();
    return status;
  }
  int MPI_Finalize()
  {
    stop();
    return PMPI_Finalize();
  }
  int MPI_Allreduce(const void* a, void* b, int n, MPI_Datatype t, MPI_Op o, MPI_Comm c)
  {
    COLLECTIVE;
    return PMPI_Allreduce(a, b, n, t, o, c);
  }
  int MPI_Bcast(void* a, int n, MPI_Datatype t, int root, MPI_Comm c)
  {
    COLLECTIVE;
    return PMPI_Bcast(a, n, t, root, c);
  }
  int MPI_Barrier(MPI_Comm c)
  {
    COLLECTIVE;
    return PMPI_Barrier(c);
  }
  int MPI_Allgather(const void* a, int n, MPI_Datatype t, void* b, int m, MPI_Datatype u,
                    MPI_Comm c)
  {
    COLLECTIVE;
    return PMPI_Allgather(a, n, t, b, m, u, c);
  }
  int MPI_Allgatherv(const void* a, int n, MPI_Datatype t, void* b, const int* m, const int* d,
                     MPI_Datatype u, MPI_Comm c)
  {
    COLLECTIVE;
    return PMPI_Allgatherv(a, n, t, b, m, d, u, c);
  }
  int MPI_Alltoall(const void* a, int n, MPI_Datatype t, void* b, int m, MPI_Datatype u, MPI_Comm c)
  {
    COLLECTIVE;
    return PMPI_Alltoall(a, n, t, b, m, u, c);
  }
  int MPI_Alltoallv(const void* a, const int* n, const int* d, MPI_Datatype t, void* b,
                    const int* m, const int* e, MPI_Datatype u, MPI_Comm c)
  {
    COLLECTIVE;
    return PMPI_Alltoallv(a, n, d, t, b, m, e, u, c);
  }

  ssize_t read(int f, void* to, size_t n)
  {
    REAL(read);
    FAIL_IF(Read, isMine(f));
    return theReal(f, to, n);
  }
  ssize_t pread(int f, void* to, size_t n, off_t at)
  {
    REAL(pread);
    FAIL_IF(Read, isMine(f));
    return theReal(f, to, n, at);
  }
  ssize_t pread64(int f, void* to, size_t n, off64_t at)
  {
    REAL(pread64);
    FAIL_IF(Read, isMine(f));
    return theReal(f, to, n, at);
  }
  ssize_t write(int f, const void* from, size_t n)
  {
    REAL(write);
    FAIL_IF(Write, isMine(f));
    return theReal(f, from, n);
  }
  ssize_t writev(int f, const iovec* from, int n)
  {
    REAL(writev);
    FAIL_IF(Write, isMine(f));
    return theReal(f, from, n);
  }
  ssize_t pwrite(int f, const void* from, size_t n, off_t at)
  {
    REAL(pwrite);
    FAIL_IF(Write, isMine(f));
    return theReal(f, from, n, at);
  }
  ssize_t pwrite64(int f, const void* from, size_t n, off64_t at)
  {
    REAL(pwrite64);
    FAIL_IF(Write, isMine(f));
    return theReal(f, from, n, at);
  }
  int fsync(int f)
  {
    REAL(fsync);
    FAIL_IF(Sync, isMine(f));
    return theReal(f);
  }
  int posix_fallocate(int f, off_t at, off_t n)
  {
    REAL(posix_fallocate);
    if (isMine(f) && fails(Reserve))
      return errorNumber;
    return theReal(f, at, n);
  }
  int rename(const char* from, const char* to)
  {
    REAL(rename);
    FAIL_IF(Rename, isMine(from));
    return theReal(from, to);
  }
  int renameat2(int fromFolder, const char* from, int toFolder, const char* to, unsigned how)
  {
    REAL(renameat2);
    FAIL_IF(Rename, isMine(from));
    return theReal(fromFolder, from, toFolder, to, how);
  }
  int close(int f)
  {
    REAL(close);
    const bool failing = isMine(f) && fails(Close);
    const int status = theReal(f);
    if (!failing)
      return status;
    errno = errorNumber;
    return -1;
  }
  int open(const char* path, int flags, ...)
  {
    REAL(open);
    va_list more;
    va_start(more, flags);
    const mode_t mode = flags & O_CREAT ? va_arg(more, mode_t) : 0;
    va_end(more);
    FAIL_IF(Open, isMine(path));
    return theReal(path, flags, mode);
  }
  int open64(const char* path, int flags, ...)
  {
    REAL(open64);
    va_list more;
    va_start(more, flags);
    const mode_t mode = flags & O_CREAT ? va_arg(more, mode_t) : 0;
    va_end(more);
    FAIL_IF(Open, isMine(path));
    return theReal(path, flags, mode);
  }
  FILE* fopen(const char* path, const char* mode)
  {
    REAL(fopen);
    if (isMine(path) && fails(Open))
    {
      errno = errorNumber;
      return nullptr;
    }
    return theReal(path, mode);
  }
  FILE* fopen64(const char* path, const char* mode)
  {
    REAL(fopen64);
    if (isMine(path) && fails(Open))
    {
      errno = errorNumber;
      return nullptr;
    }
    return theReal(path, mode);
  }
}
