/* Counts what MPI is asked to move: preload it into any program (measure.py does).

   Every call of the profiled functions is counted with the bytes that this rank gives to it. At the end each rank
   writes one line of JSON to $TRAFFIC.<rank>: {"function": [calls, bytes], ...} and "largest": peak memory [bytes]. */
#define _GNU_SOURCE
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>

enum { SEND, ISEND, ALLREDUCE, ALLGATHER, ALLGATHERV, ALLTOALL, ALLTOALLV, BCAST, REDUCE, SCAN, BARRIER, KINDS };
static const char *names[KINDS] = {"Send",     "Isend",     "Allreduce", "Allgather", "Allgatherv", "Alltoall",
                                   "Alltoallv", "Bcast",     "Reduce",    "Scan",      "Barrier"};
static long long calls[KINDS], bytes[KINDS];

static void count(int kind, long long number, MPI_Datatype type)
{
  int size = 0;
  if (number > 0)
    PMPI_Type_size(type, &size);
  ++calls[kind];
  bytes[kind] += number * size;
}

int MPI_Send(const void *b, int n, MPI_Datatype t, int to, int tag, MPI_Comm c)
{
  count(SEND, n, t);
  return PMPI_Send(b, n, t, to, tag, c);
}
int MPI_Ssend(const void *b, int n, MPI_Datatype t, int to, int tag, MPI_Comm c)
{
  count(SEND, n, t);
  return PMPI_Ssend(b, n, t, to, tag, c);
}
int MPI_Rsend(const void *b, int n, MPI_Datatype t, int to, int tag, MPI_Comm c)
{
  count(SEND, n, t);
  return PMPI_Rsend(b, n, t, to, tag, c);
}
int MPI_Isend(const void *b, int n, MPI_Datatype t, int to, int tag, MPI_Comm c, MPI_Request *r)
{
  count(ISEND, n, t);
  return PMPI_Isend(b, n, t, to, tag, c, r);
}
int MPI_Allreduce(const void *s, void *r, int n, MPI_Datatype t, MPI_Op o, MPI_Comm c)
{
  count(ALLREDUCE, n, t);
  return PMPI_Allreduce(s, r, n, t, o, c);
}
int MPI_Reduce(const void *s, void *r, int n, MPI_Datatype t, MPI_Op o, int root, MPI_Comm c)
{
  count(REDUCE, n, t);
  return PMPI_Reduce(s, r, n, t, o, root, c);
}
int MPI_Scan(const void *s, void *r, int n, MPI_Datatype t, MPI_Op o, MPI_Comm c)
{
  count(SCAN, n, t);
  return PMPI_Scan(s, r, n, t, o, c);
}
int MPI_Allgather(const void *s, int n, MPI_Datatype t, void *r, int m, MPI_Datatype u, MPI_Comm c)
{
  count(ALLGATHER, n, t);
  return PMPI_Allgather(s, n, t, r, m, u, c);
}
int MPI_Allgatherv(const void *s, int n, MPI_Datatype t, void *r, const int *m, const int *d, MPI_Datatype u, MPI_Comm c)
{
  count(ALLGATHERV, n, t);
  return PMPI_Allgatherv(s, n, t, r, m, d, u, c);
}
int MPI_Alltoall(const void *s, int n, MPI_Datatype t, void *r, int m, MPI_Datatype u, MPI_Comm c)
{
  int ranks;
  PMPI_Comm_size(c, &ranks);
  count(ALLTOALL, (long long)n * ranks, t);
  return PMPI_Alltoall(s, n, t, r, m, u, c);
}
int MPI_Alltoallv(const void *s, const int *n, const int *d, MPI_Datatype t, void *r, const int *m, const int *e,
                  MPI_Datatype u, MPI_Comm c)
{
  int ranks;
  long long number = 0;
  PMPI_Comm_size(c, &ranks);
  for (int i = 0; i < ranks; ++i)
    number += n[i];
  count(ALLTOALLV, number, t);
  return PMPI_Alltoallv(s, n, d, t, r, m, e, u, c);
}
int MPI_Bcast(void *b, int n, MPI_Datatype t, int root, MPI_Comm c)
{
  count(BCAST, n, t);
  return PMPI_Bcast(b, n, t, root, c);
}
int MPI_Barrier(MPI_Comm c)
{
  count(BARRIER, 0, MPI_BYTE);
  return PMPI_Barrier(c);
}

int MPI_Finalize(void)
{
  const char *base = getenv("TRAFFIC");
  if (base)
  {
    int rank;
    char name[4096];
    struct rusage usage;
    PMPI_Comm_rank(MPI_COMM_WORLD, &rank);
    getrusage(RUSAGE_SELF, &usage);
    snprintf(name, sizeof name, "%s.%d", base, rank);
    FILE *file = fopen(name, "w");
    if (file)
    {
      fprintf(file, "{\"largest\": %lld", 1024LL * usage.ru_maxrss);
      for (int k = 0; k < KINDS; ++k)
        fprintf(file, ", \"%s\": [%lld, %lld]", names[k], calls[k], bytes[k]);
      fprintf(file, "}\n");
      fclose(file);
    }
  }
  return PMPI_Finalize();
}
