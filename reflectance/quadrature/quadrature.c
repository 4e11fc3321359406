#include "reflectance/quadrature/quadrature.h"

enum { FIRST_PANELS = 6, MAX_DEPTH = 40, MAX_HALVINGS = 2000, PAIRS = 7 };

/* In binary128 the integral is there to be compared with: it ends at what the digits of the rule below allow. */
#define RELATIVE_TOLERANCE (WEFT_REAL_EPSILON < 1e-30 ? 1e-14 : 1e-9)

static const weft_real node[PAIRS] = {0.991455371120812639206854697526329, 0.949107912342758524526189684047851,
                                      0.864864423359769072789712788640926, 0.741531185599394439863864773280788,
                                      0.586087235467691130294144691258380, 0.405845151377397166906606412076961,
                                      0.207784955007898467600689403773245};
static const weft_real kronrod_weight[PAIRS] = {
    0.022935322010529224963732008058970, 0.063092092629978553290700663189204, 0.104790010322250183839876322541518,
    0.140653259715525918745189590510238, 0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
    0.204432940075298892414161999234649};
static const weft_real kronrod_middle = 0.209482141084727828012999174891714;

/* Of the odd nodes. */
static const weft_real gauss_weight[PAIRS / 2] = {
    0.129484966168869693270611432679082, 0.279705391489276667901467771423780, 0.381830050505118944950369775488975};
static const weft_real gauss_middle = 0.417959183673469387755102040816327;

typedef struct problem {
    weft_integrand function;
    const void *context;
    weft_real low, high;
    weft_real relative;  /* tolerance of a panel relative to itself */
    weft_real tolerance; /* absolute, per panel */
    int halvings;        /* left: a function that is all rounding (a spine that ends in a spike) would never end */
} problem;

typedef struct estimate {
    weft_real value, error;
} estimate;

weft_abscissa weft_abscissa_at(weft_real low, weft_real high, weft_real theta)
{
    weft_real sine = sin(theta / 2), cosine = cos(theta / 2);
    weft_abscissa at = {.from_low = (high - low) * sine * sine, .to_high = (high - low) * cosine * cosine};
    at.x = sine < cosine ? low + at.from_low : high - at.to_high;
    return at;
}

static weft_real transformed(const problem *p, weft_real theta)
{
    weft_abscissa at = weft_abscissa_at(p->low, p->high, theta);
    return p->function(p->context, &at) * sin(theta) * ((p->high - p->low) / 2);
}

static estimate gauss_kronrod(const problem *p, weft_real low, weft_real high)
{
    weft_real centre = (low + high) / 2, radius = (high - low) / 2;
    weft_real at_centre = transformed(p, centre);
    weft_real kronrod = kronrod_middle * at_centre, gauss = gauss_middle * at_centre;
    for (int i = 0; i < PAIRS; i++) {
        weft_real pair = transformed(p, centre - radius * node[i]) + transformed(p, centre + radius * node[i]);
        kronrod += kronrod_weight[i] * pair;
        if (i % 2 == 1)
            gauss += gauss_weight[i / 2] * pair;
    }
    return (estimate){kronrod * radius, fabs(kronrod - gauss) * radius};
}

static weft_real refine(problem *p, weft_real low, weft_real high, estimate whole, int depth)
{
    /* Integrands are not negative, so that a relative error of every panel is one of the whole. It ends the refinement
     * also where the first panels missed a peak and the tolerance is below the rounding of what was found later. */
    weft_real enough = fmax(p->tolerance, p->relative * fabs(whole.value));
    if (!(whole.error > enough) || depth == MAX_DEPTH || p->halvings == 0)
        return whole.value;
    p->halvings--;
    weft_real centre = (low + high) / 2;
    return refine(p, low, centre, gauss_kronrod(p, low, centre), depth + 1) +
           refine(p, centre, high, gauss_kronrod(p, centre, high), depth + 1);
}

static weft_real panel_edge(int panel)
{
    return (weft_real)WEFT_PI * (weft_real)panel / FIRST_PANELS;
}

weft_real weft_integrate(weft_integrand function, const void *context, weft_real low, weft_real high)
{
    problem p = {.function = function, .context = context, .low = low, .high = high, .halvings = MAX_HALVINGS};
    p.relative = fmax((weft_real)RELATIVE_TOLERANCE, 8 * (weft_real)WEFT_REAL_EPSILON);
    estimate first[FIRST_PANELS];
    weft_real total = 0;
    for (int i = 0; i < FIRST_PANELS; i++) {
        first[i] = gauss_kronrod(&p, panel_edge(i), panel_edge(i + 1));
        p.tolerance += fabs(first[i].value);
    }
    p.tolerance *= fmax((weft_real)RELATIVE_TOLERANCE, (weft_real)WEFT_REAL_EPSILON);
    for (int i = 0; i < FIRST_PANELS; i++)
        total += refine(&p, panel_edge(i), panel_edge(i + 1), first[i], 0);
    return total;
}
