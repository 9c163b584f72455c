/* The calls into MPI, whose types and constants only its own header knows.
 *
 * MPI 3.1, chapters 5 (collective communication), 8.7 (startup), 12.4 (threads). Errors are returned, not fatal. */

#include <mpi.h>
#include <stdint.h>
#include <stdlib.h>

static void leave(void)
{
    int finalized = 0;
    MPI_Finalized(&finalized);
    if (!finalized)
        MPI_Finalize();
}

/* Enters MPI for calls of any one thread at a time; what the process does at its end leaves it. */
int signorini_ranks_enter(int32_t *rank, int32_t *size)
{
    int initialized = 0, given = 0;
    int code = MPI_Initialized(&initialized);
    if (code == MPI_SUCCESS && !initialized) {
        code = MPI_Init_thread(NULL, NULL, MPI_THREAD_SERIALIZED, &given);
        if (code == MPI_SUCCESS)
            atexit(leave);
    }
    if (code == MPI_SUCCESS)
        code = MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
    int of_rank = 0, of_size = 1;
    if (code == MPI_SUCCESS)
        code = MPI_Comm_rank(MPI_COMM_WORLD, &of_rank);
    if (code == MPI_SUCCESS)
        code = MPI_Comm_size(MPI_COMM_WORLD, &of_size);
    *rank = of_rank;
    *size = of_size;
    return code;
}

int signorini_ranks_all_gather(const double *own, int32_t count, double *all, const int32_t *counts, const int32_t *first)
{
    return MPI_Allgatherv(own, count, MPI_DOUBLE, all, counts, first, MPI_DOUBLE, MPI_COMM_WORLD);
}

int signorini_ranks_broadcast(uint8_t *bytes, int32_t count)
{
    return MPI_Bcast(bytes, count, MPI_UINT8_T, 0, MPI_COMM_WORLD);
}

int signorini_ranks_least(uint64_t *numbers, int32_t count)
{
    return MPI_Allreduce(MPI_IN_PLACE, numbers, count, MPI_UINT64_T, MPI_MIN, MPI_COMM_WORLD);
}

void signorini_ranks_abort(int32_t code)
{
    MPI_Abort(MPI_COMM_WORLD, code);
}
