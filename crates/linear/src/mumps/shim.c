/* The calls into MUMPS behind an opaque handle: only here is its structure known, from the header of the machine.
 *
 * MUMPS 5.5 Users' guide, sections 5 (parameters), 6 (ICNTL), 8 (INFOG). No call prints, and none is safe beside another
 * one, on whatever handle. */

#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdint.h>
#include <stdlib.h>
#include <dmumps_c.h>

_Static_assert(sizeof(MUMPS_INT) == sizeof(int32_t), "a MUMPS with 32-bit integers is needed");

/* The numbers of the manual: ICNTL(i), INFOG(i). */
#define ICNTL(i) icntl[(i) - 1]
#define INFOG(i) infog[(i) - 1]

enum { INITIALIZE = -1, TERMINATE = -2, ANALYZE = 1, FACTORIZE = 2, SOLVE = 3 };
enum { COMM_WORLD = -987654 };

struct status {
    int32_t code;   /* INFOG(1): 0 is well, negative an error */
    int32_t detail; /* INFOG(2): what more there is to say */
};

/* What the dense kernels of MUMPS take from OpenBLAS, where it is OpenBLAS, they take on one thread: the same bits
 * whatever the number of threads. */
static void one_thread(void)
{
    void (*set)(int);
    *(void **)&set = dlsym(RTLD_DEFAULT, "openblas_set_num_threads");
    if (set != NULL)
        set(1);
}

static struct status call(DMUMPS_STRUC_C *id, int job)
{
    id->job = job;
    dmumps_c(id);
    return (struct status){id->INFOG(1), id->INFOG(2)};
}

/* symmetry: 0 none, 1 definite, 2 general. NULL where there is no memory. */
DMUMPS_STRUC_C *signorini_mumps_new(int32_t symmetry)
{
    DMUMPS_STRUC_C *id = calloc(1, sizeof *id);
    if (id == NULL)
        return NULL;
    one_thread();
    id->sym = symmetry;
    id->par = 1;
    id->comm_fortran = COMM_WORLD;
    if (call(id, INITIALIZE).code < 0) {
        free(id);
        return NULL;
    }
    id->ICNTL(1) = -1; /* no messages */
    id->ICNTL(2) = -1;
    id->ICNTL(3) = -1;
    id->ICNTL(4) = 0;
    id->ICNTL(6) = 0;  /* no permutation by values: they are not known yet */
    id->ICNTL(7) = 1;  /* the order is given */
    id->ICNTL(8) = 0;  /* no scaling: it has been done */
    id->ICNTL(12) = 1; /* nor does the order follow values */
    id->ICNTL(13) = 1; /* the last front like all others, so that negative pivots are all counted */
    id->ICNTL(16) = 1; /* one thread */
    id->ICNTL(24) = 0; /* a zero pivot is an error */
    id->ICNTL(28) = 1; /* one process */
    return id;
}

void signorini_mumps_free(DMUMPS_STRUC_C *id)
{
    call(id, TERMINATE);
    free(id);
}

/* rows and columns count from 1, place[i] is the step in which unknown i is eliminated. */
struct status signorini_mumps_analyze(DMUMPS_STRUC_C *id, int32_t n, int64_t nentry, int32_t *row, int32_t *column,
                                      int32_t *place)
{
    id->n = n;
    id->nnz = nentry;
    id->irn = row;
    id->jcn = column;
    id->perm_in = place;
    struct status status = call(id, ANALYZE);
    id->irn = id->jcn = id->perm_in = NULL;
    return status;
}

/* spare: working space beyond the estimate, in per cent. */
struct status signorini_mumps_factorize(DMUMPS_STRUC_C *id, int32_t *row, int32_t *column, double *value,
                                        int32_t spare)
{
    id->ICNTL(14) = spare;
    id->irn = row;
    id->jcn = column;
    id->a = value;
    struct status status = call(id, FACTORIZE);
    id->irn = id->jcn = NULL;
    id->a = NULL;
    return status;
}

/* Negative pivots of the last factor. */
int32_t signorini_mumps_negative_pivots(const DMUMPS_STRUC_C *id)
{
    return id->INFOG(12);
}

/* x: the right-hand side, then the solution. */
struct status signorini_mumps_solve(DMUMPS_STRUC_C *id, double *x)
{
    id->nrhs = 1;
    id->lrhs = id->n;
    id->rhs = x;
    struct status status = call(id, SOLVE);
    id->rhs = NULL;
    return status;
}
