/* One channel of one texel on plain arrays of double, for solvers that know nothing of Weft, with everything that they
 * share: the model and its derivatives, T(v) by eq. 4 of Daubert et al. 2001, the start, and the judge of a result.
 *
 *     r = T(v) k (rho + sum_i A_i max(0, b_i)^N_i),    b_i = cx_i lx vx + cy_i ly vy + lz vz,    k = sqrt(w) l_z
 *
 * Parameters: rho; A, cx, cy, ln N of every lobe. cz = 1 takes out the freedom between A and the length of c, which is
 * kinder to a solver than Cx, Cy, Cz, N as they stand in the paper: nothing overflows. */
#ifndef WEFT_BENCH_FIT_PROBLEM_H
#define WEFT_BENCH_FIT_PROBLEM_H

#ifdef __cplusplus
extern "C" {
#endif

enum { PROBLEM_LOBES = 3, PROBLEM_PARAMETERS = 1 + 4 * PROBLEM_LOBES };

typedef struct problem problem;

/* The model over the samples [begin, end): its value into given->model, powers and logarithms beside it; then its
 * derivatives by every parameter, column[p][i], at the x of the last evaluation of those samples. */
typedef struct model_code {
    void (*evaluate)(problem *given, const double *x, int begin, int end);
    void (*differentiate)(problem *given, const double *x, int begin, int end);
} model_code;

/* The same source (model.c) compiled twice: with the exp and log of the C library for vectors of the machine at hand,
 * which is to the advantage of the solvers compared, and with its scalar ones, as most programs have them. */
extern const model_code model_vector, model_scalar;

struct problem {
    const model_code *code;
    int sample_count, view_count, lobe_count, parameter_count;
    int fits_table;      /* 0: T = 1 */
    double max_exponent; /* N in [1, max_exponent] where a solver knows bounds; rho, A, T >= 0; |cx|, |cy| <= 1.5 */
    double tolerance;    /* stop when a step lowers the residual by less than this fraction */
    int *first;          /* [view_count + 1] first sample of every view */
    double *product[3];  /* [sample_count] lx vx, ly vy, lz vz in the frame of the texel */
    double *cosine;      /* [sample_count] k */
    double *value;       /* [sample_count] root of the weight times the sample */
    double *power[3];    /* [sample_count] scratch: b^N of the last evaluation */
    double *log_base[3]; /* [sample_count] scratch: ln b */
    double *model;       /* [sample_count] scratch: k (rho + ...), without T */
    double *column;      /* [PROBLEM_PARAMETERS][sample_count] scratch: its derivatives */
    int passes;          /* sweeps over all samples so far: model, derivatives and T count one each */
};

/* What a solver found. */
typedef struct solution {
    double x[PROBLEM_PARAMETERS];
    double *table; /* [view_count], the caller's */
} solution;

/* T by eq. 4 from given->model, at least 0, 1 where a view tells nothing; returns the mean change of T. */
double problem_update_table(problem *given, double *table);

/* Start number 0 (a mirror lobe, a broad one, one thrown back) or 1 (retro-reflective first): the shapes that the joint
 * fit of Weft starts from; rho and A from the mean brightness as the paper does; T = 1. */
void problem_start(problem *given, int index, solution *result);

/* Sum of squared residuals. */
double problem_residual(problem *given, const solution *found);

#ifdef __cplusplus
}
#endif

#endif
