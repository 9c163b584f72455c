/* The calls into PETSc, whose types only its own headers know.
 *
 * PETSc Users' Manual, chapters "Vectors", "Matrices", "KSP" and "PCGAMG"; every option that bears on a result is set here,
 * since defaults change between releases. Calls are collective over all ranks of MPI_COMM_WORLD. Each returns PETSc's code
 * of an error, 0 where there is none. */

#include <petscksp.h>
#include <stdint.h>
#include <stdlib.h>

_Static_assert(sizeof(PetscInt) == sizeof(int32_t), "a PETSc with 32-bit integers is needed");
_Static_assert(sizeof(PetscScalar) == sizeof(double), "a PETSc of real numbers in double precision is needed");

enum { MODES = 6 };

struct share {
    Mat operator;           /* all equations */
    Vec x, y;
    Mat bodies;             /* the stiffness of the bodies with springs */
    PC cycle;
    Vec b, z;
    Vec near;               /* entries that this rank asks for */
    VecScatter scatter;
};

static const char *const OPTIONS[][2] = {
    {"-signorini_pc_type", "gamg"},
    {"-signorini_pc_gamg_type", "agg"},
    {"-signorini_pc_gamg_agg_nsmooths", "1"},
    {"-signorini_pc_gamg_threshold", "0"},
    {"-signorini_pc_gamg_threshold_scale", "1"},
    {"-signorini_pc_gamg_aggressive_coarsening", "0"},
    {"-signorini_pc_gamg_coarse_eq_limit", "600"},
    {"-signorini_pc_gamg_process_eq_limit", "200"},
    {"-signorini_pc_gamg_repartition", "false"},
    {"-signorini_pc_gamg_parallel_coarse_grid_solver", "false"},
    {"-signorini_pc_gamg_reuse_interpolation", "false"},
    {"-signorini_pc_gamg_sym_graph", "false"},
    {"-signorini_pc_gamg_esteig_ksp_type", "cg"},
    {"-signorini_pc_gamg_esteig_ksp_max_it", "10"},
    {"-signorini_pc_gamg_use_sa_esteig", "true"},
    {"-signorini_pc_mg_type", "multiplicative"},
    {"-signorini_pc_mg_cycle_type", "v"},
    {"-signorini_mg_levels_ksp_type", "chebyshev"},
    {"-signorini_mg_levels_ksp_max_it", "2"},
    {"-signorini_mg_levels_ksp_norm_type", "none"},
    {"-signorini_mg_levels_ksp_chebyshev_esteig", "0,0.1,0,1.1"},
    {"-signorini_mg_levels_ksp_chebyshev_esteig_steps", "10"},
    {"-signorini_mg_levels_ksp_chebyshev_esteig_noisy", "true"},
    {"-signorini_mg_levels_esteig_ksp_type", "cg"},
    {"-signorini_mg_levels_pc_type", "bjacobi"},
    {"-signorini_mg_levels_sub_ksp_type", "preonly"},
    {"-signorini_mg_levels_sub_pc_type", "icc"},
    {"-signorini_mg_levels_sub_pc_factor_levels", "0"},
    {"-signorini_mg_levels_sub_pc_factor_shift_type", "positive_definite"},
    {"-signorini_mg_levels_sub_pc_factor_mat_ordering_type", "natural"},
    {"-signorini_mg_coarse_ksp_type", "preonly"},
    {"-signorini_mg_coarse_pc_type", "bjacobi"},
    {"-signorini_mg_coarse_sub_ksp_type", "preonly"},
    {"-signorini_mg_coarse_sub_pc_type", "cholesky"},
    {"-signorini_mg_coarse_sub_pc_factor_shift_type", "nonzero"},
    {"-signorini_mg_coarse_sub_pc_factor_mat_ordering_type", "nd"},
};

static void leave(void)
{
    PetscBool finalized = PETSC_FALSE;
    PetscFinalized(&finalized);
    if (!finalized)
        PetscFinalize();
}

/* Sets an option, unless PETSC_OPTIONS has it. */
static PetscErrorCode set(const char *name, const char *value)
{
    PetscBool given = PETSC_FALSE;
    PetscCall(PetscOptionsHasName(NULL, NULL, name, &given));
    return given ? 0 : PetscOptionsSetValue(NULL, name, value);
}

/* Enters PETSc once. MPI has been entered before. */
static PetscErrorCode enter(void)
{
    PetscBool initialized = PETSC_FALSE;
    int size = 1;
    PetscCall(PetscInitialized(&initialized));
    if (initialized)
        return 0;
    PetscCall(PetscInitializeNoArguments());
    /* signals are the program's, and errors go to the caller without a text */
    PetscCall(PetscPopSignalHandler());
    PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
    atexit(leave);
    for (size_t k = 0; k < sizeof OPTIONS / sizeof *OPTIONS; ++k)
        PetscCall(set(OPTIONS[k][0], OPTIONS[k][1]));
    /* what comes from several ranks is added up as it comes, which is other bits every time; this way takes six times as
     * long, and adds it up in the order of ranks */
    PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
    if (size > 2)
        PetscCall(set("-matptap_via", "allatonce"));
    return 0;
}

int signorini_petsc_new(struct share **made)
{
    PetscCall(enter());
    *made = calloc(1, sizeof **made);
    return *made == NULL ? PETSC_ERR_MEM : 0;
}

static PetscErrorCode free_bodies(struct share *s)
{
    PetscCall(PCDestroy(&s->cycle));
    PetscCall(MatDestroy(&s->bodies));
    PetscCall(VecDestroy(&s->b));
    PetscCall(VecDestroy(&s->z));
    return 0;
}

int signorini_petsc_free(struct share *s)
{
    PetscBool finalized = PETSC_FALSE;
    PetscCall(PetscFinalized(&finalized));
    if (!finalized) {
        PetscCall(free_bodies(s));
        PetscCall(MatDestroy(&s->operator));
        PetscCall(VecDestroy(&s->x));
        PetscCall(VecDestroy(&s->y));
        PetscCall(VecScatterDestroy(&s->scatter));
        PetscCall(VecDestroy(&s->near));
    }
    free(s);
    return 0;
}

/* The rows of this rank, with columns as all ranks number them. */
int signorini_petsc_operator(struct share *s, int32_t nrow, const int32_t *start, const int32_t *column,
                             const double *value)
{
    PetscCall(MatDestroy(&s->operator));
    PetscCall(VecDestroy(&s->x));
    PetscCall(VecDestroy(&s->y));
    PetscCall(MatCreateMPIAIJWithArrays(PETSC_COMM_WORLD, nrow, nrow, PETSC_DETERMINE, PETSC_DETERMINE, start, column,
                                        value, &s->operator));
    PetscCall(MatCreateVecs(s->operator, &s->x, &s->y));
    return 0;
}

/* Other values of the same rows. */
int signorini_petsc_values(struct share *s, const double *value)
{
    return MatUpdateMPIAIJWithArray(s->operator, value);
}

static PetscErrorCode place(Vec v, const double *from)
{
    PetscInt n;
    PetscScalar *to;
    PetscCall(VecGetLocalSize(v, &n));
    PetscCall(VecGetArrayWrite(v, &to));
    PetscCall(PetscArraycpy(to, from, n));
    PetscCall(VecRestoreArrayWrite(v, &to));
    return 0;
}

static PetscErrorCode take(Vec v, double *to)
{
    PetscInt n;
    const PetscScalar *from;
    PetscCall(VecGetLocalSize(v, &n));
    PetscCall(VecGetArrayRead(v, &from));
    PetscCall(PetscArraycpy(to, from, n));
    PetscCall(VecRestoreArrayRead(v, &from));
    return 0;
}

/* y = A x, of x and y the entries of this rank. */
int signorini_petsc_multiply(struct share *s, const double *x, double *y)
{
    PetscCall(place(s->x, x));
    PetscCall(MatMult(s->operator, s->x, s->y));
    PetscCall(take(s->y, y));
    return 0;
}

/* The entries of vectors of all equations that this rank asks for. */
int signorini_petsc_ask(struct share *s, int32_t count, const int32_t *number)
{
    IS from, to;
    PetscCall(VecScatterDestroy(&s->scatter));
    PetscCall(VecDestroy(&s->near));
    PetscCall(VecCreateSeq(PETSC_COMM_SELF, count, &s->near));
    PetscCall(ISCreateGeneral(PETSC_COMM_SELF, count, number, PETSC_COPY_VALUES, &from));
    PetscCall(ISCreateStride(PETSC_COMM_SELF, count, 0, 1, &to));
    PetscCall(VecScatterCreate(s->x, from, s->near, to, &s->scatter));
    PetscCall(ISDestroy(&from));
    PetscCall(ISDestroy(&to));
    return 0;
}

/* Those of a vector of which this rank has `own`. */
int signorini_petsc_answer(struct share *s, const double *own, double *asked)
{
    PetscCall(place(s->x, own));
    PetscCall(VecScatterBegin(s->scatter, s->x, s->near, INSERT_VALUES, SCATTER_FORWARD));
    PetscCall(VecScatterEnd(s->scatter, s->x, s->near, INSERT_VALUES, SCATTER_FORWARD));
    PetscCall(take(s->near, asked));
    return 0;
}

/* Motions of rigid bodies, one after the other, made orthonormal; those that depend on others are left out. */
static PetscErrorCode near_null_space(Mat of, const double *modes)
{
    Vec kept[MODES], v;
    PetscInt nkept = 0, n;
    MatNullSpace space;
    PetscCall(MatGetLocalSize(of, &n, NULL));
    for (int k = 0; k < MODES; ++k) {
        PetscReal before, after;
        PetscScalar product;
        PetscCall(MatCreateVecs(of, &v, NULL));
        PetscCall(VecSetBlockSize(v, 3));
        PetscCall(place(v, modes + (size_t)k * n));
        PetscCall(VecNorm(v, NORM_2, &before));
        for (int twice = 0; twice < 2; ++twice)
            for (PetscInt i = 0; i < nkept; ++i) {
                PetscCall(VecDot(v, kept[i], &product));
                PetscCall(VecAXPY(v, -product, kept[i]));
            }
        PetscCall(VecNorm(v, NORM_2, &after));
        if (after > 1e-8 * before) {
            PetscCall(VecScale(v, 1.0 / after));
            kept[nkept++] = v;
        } else {
            PetscCall(VecDestroy(&v));
        }
    }
    PetscCall(MatNullSpaceCreate(PETSC_COMM_WORLD, PETSC_FALSE, nkept, kept, &space));
    PetscCall(MatSetNearNullSpace(of, space));
    PetscCall(MatNullSpaceDestroy(&space));
    for (PetscInt i = 0; i < nkept; ++i)
        PetscCall(VecDestroy(&kept[i]));
    return 0;
}

/* Makes the hierarchy of a matrix by blocks of three: `modes` are six motions at the rows of this rank. */
int signorini_petsc_bodies(struct share *s, int32_t nrow, const int32_t *start, const int32_t *column,
                           const double *value, const double *modes)
{
    PetscCall(free_bodies(s));
    PetscCall(MatCreate(PETSC_COMM_WORLD, &s->bodies));
    PetscCall(MatSetSizes(s->bodies, nrow, nrow, PETSC_DETERMINE, PETSC_DETERMINE));
    PetscCall(MatSetBlockSize(s->bodies, 3));
    PetscCall(MatSetType(s->bodies, MATMPIAIJ));
    PetscCall(MatMPIAIJSetPreallocationCSR(s->bodies, start, column, value));
    PetscCall(MatSetOption(s->bodies, MAT_SPD, PETSC_TRUE));
    PetscCall(MatCreateVecs(s->bodies, &s->b, &s->z));
    PetscCall(near_null_space(s->bodies, modes));
    PetscCall(PCCreate(PETSC_COMM_WORLD, &s->cycle));
    PetscCall(PCSetOptionsPrefix(s->cycle, "signorini_"));
    PetscCall(PCSetOperators(s->cycle, s->bodies, s->bodies));
    PetscCall(PCSetFromOptions(s->cycle));
    PetscCall(PCSetUp(s->cycle));
    return 0;
}

/* One cycle, z of b. `failed` is PETSc's reason where a smoother or the coarsest level has failed on some rank, else 0. */
int signorini_petsc_cycle(struct share *s, const double *b, double *z, int32_t *failed)
{
    PCFailedReason reason;
    PetscCall(place(s->b, b));
    PetscCall(PCApply(s->cycle, s->b, s->z));
    PetscCall(PCGetFailedReason(s->cycle, &reason));
    *failed = reason;
    PetscCall(take(s->z, z));
    return 0;
}

/* Levels of the hierarchy. */
int signorini_petsc_levels(struct share *s, int32_t *levels)
{
    PetscInt n;
    PetscCall(PCMGGetLevels(s->cycle, &n));
    *levels = n;
    return 0;
}
