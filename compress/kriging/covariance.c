#include "compress/kriging/covariance.h"

#include "reflectance/components/components.h"

/* Powers of smaller cosines than that of 84 degrees are those of that one: directions nearer to the horizon are rarely
 * photographed, and tell nothing of how highlights go on. */
static const double least_cosine = 0.1;

weft_direction_pair weft_direction_pair_of(weft_vec3 light, weft_vec3 view)
{
    weft_vec3 half_vector = weft_half_vector(light, view);
    double light_cosine = fmax((double)light.z, least_cosine), view_cosine = fmax((double)view.z, least_cosine);
    return (weft_direction_pair){.light = {(double)light.x, (double)light.y, (double)light.z},
                                 .view = {(double)view.x, (double)view.y, (double)view.z},
                                 .half_vector = {(double)half_vector.x, (double)half_vector.y, (double)half_vector.z},
                                 .log_incidence = log(fmax((double)weft_dot(light, half_vector), WEFT_LEAST_INCIDENCE)),
                                 .log_light = log(light_cosine),
                                 .log_view = log(view_cosine),
                                 .cosine_ratio = light_cosine / view_cosine};
}

/* Where the search for the covariance of a dataset begins: highlights of some 30 degrees, all else wider. Highlights
 * grow with the inverse cosine of incidence. */
weft_covariance weft_covariance_usual(void)
{
    return (weft_covariance){.number = {[WEFT_NOISE] = -4,
                                        [WEFT_DIFFUSE_VARIANCE] = 3,
                                        [WEFT_SMOOTH_VIEW_LENGTH] = 0.5,
                                        [WEFT_HIGHLIGHT_LENGTH] = -1,
                                        [WEFT_HIGHLIGHT_VIEW_LENGTH] = 0.5,
                                        [WEFT_FIXED_HIGHLIGHT_LENGTH] = -1,
                                        [WEFT_INCIDENCE_POWER] = -2}};
}

weft_covariance weft_covariance_usual_of_mean(void)
{
    weft_covariance covariance = weft_covariance_usual();
    covariance.number[WEFT_RECIPROCITY] = covariance.number[WEFT_HALF_TURN] = 3;
    covariance.is_of_mean = true;
    return covariance;
}

weft_covariance weft_covariance_diffuse(void)
{
    weft_covariance covariance = weft_covariance_usual();
    covariance.number[WEFT_DIFFUSE_VARIANCE] = 8;
    covariance.number[WEFT_HIGHLIGHT_VARIANCE] = -8;
    covariance.number[WEFT_FIXED_HIGHLIGHT_VARIANCE] = -8;
    return covariance;
}

static double share_of(double log2_of_odds)
{
    return 1 / (1 + exp2(-log2_of_odds));
}

/* 3 / length^2: the factor that M takes is in it. */
static double scale_of(double log2_of_length)
{
    return 3 * exp2(-2 * log2_of_length);
}

weft_covariance_terms weft_covariance_terms_of(const weft_covariance *covariance)
{
    const double *number = covariance->number;
    return (weft_covariance_terms){.diffuse = exp2(number[WEFT_DIFFUSE_VARIANCE]),
                                   .highlight = exp2(number[WEFT_HIGHLIGHT_VARIANCE]),
                                   .fixed = exp2(number[WEFT_FIXED_HIGHLIGHT_VARIANCE]),
                                   .smooth_light = scale_of(number[WEFT_SMOOTH_LIGHT_LENGTH]),
                                   .smooth_view = scale_of(number[WEFT_SMOOTH_VIEW_LENGTH]),
                                   .highlight_half = scale_of(number[WEFT_HIGHLIGHT_LENGTH]),
                                   .highlight_view = scale_of(number[WEFT_HIGHLIGHT_VIEW_LENGTH]),
                                   .fixed_half = scale_of(number[WEFT_FIXED_HIGHLIGHT_LENGTH]),
                                   .incidence_power = number[WEFT_INCIDENCE_POWER] / 2,
                                   .light_power = number[WEFT_LIGHT_POWER] / 2,
                                   .view_power = number[WEFT_VIEW_POWER] / 2,
                                   .is_of_mean = covariance->is_of_mean,
                                   .reciprocity = share_of(number[WEFT_RECIPROCITY]),
                                   .half_turn = share_of(number[WEFT_HALF_TURN])};
}

static double squared_distance(const double a[3], const double b[3])
{
    double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    return x * x + y * y + z * z;
}

/* Of three times the squared distance. */
static double matern(double scaled)
{
    double distance = sqrt(scaled);
    return (1 + distance) * exp(-distance);
}

static double growth_of(const weft_covariance_terms *terms, const weft_direction_pair *a, const weft_direction_pair *b)
{
    return exp(terms->incidence_power * (a->log_incidence + b->log_incidence) +
               terms->light_power * (a->log_light + b->log_light) + terms->view_power * (a->log_view + b->log_view));
}

/* Of squared distances between lights, views and half vectors; `fixed` is the highlight that the view does not change.
 */
static double covariance_of(const weft_covariance_terms *terms, double diffuse, double light, double view,
                            double half_vector, double fixed, double growth)
{
    double highlight = terms->highlight * matern(terms->highlight_half * half_vector + terms->highlight_view * view);
    return terms->diffuse * diffuse + matern(terms->smooth_light * light + terms->smooth_view * view) +
           growth * (highlight + fixed);
}

/* ---- The mean over texels ---- */

static weft_direction_pair half_turned(const weft_direction_pair *pair)
{
    weft_direction_pair result = *pair;
    for (int i = 0; i < 2; i++) {
        result.light[i] = -pair->light[i];
        result.view[i] = -pair->view[i];
        result.half_vector[i] = -pair->half_vector[i];
    }
    return result;
}

/* What becomes of g where light and view change places. */
static double growth_swapped(const weft_covariance_terms *terms, const weft_direction_pair *pair)
{
    double powers = terms->view_power - terms->light_power;
    return powers == 0 ? 1 : exp(powers * (pair->log_light - pair->log_view));
}

/* c: as far as it is reciprocal, of pairs of growth g g'. What is reciprocal is the reflectance without the cosine: u
 * brings that back. */
static double between_reciprocal(const weft_covariance_terms *terms, const weft_direction_pair *a,
                                 const weft_direction_pair *b, double growth)
{
    const double *l = a->light, *v = a->view, *m = b->light, *w = b->view;
    double lights = squared_distance(l, m), views = squared_distance(v, w), ahead = squared_distance(l, w),
           back = squared_distance(v, m), half_vectors = squared_distance(a->half_vector, b->half_vector);
    double fixed = terms->fixed * matern(terms->fixed_half * half_vectors);
    double grown_a = growth_swapped(terms, a), grown_b = growth_swapped(terms, b);
    double same = covariance_of(terms, l[2] * m[2], lights, views, half_vectors, fixed, growth);
    double a_swapped = covariance_of(terms, v[2] * m[2], back, ahead, half_vectors, fixed, growth * grown_a);
    double b_swapped = covariance_of(terms, l[2] * w[2], ahead, back, half_vectors, fixed, growth * grown_b);
    double both = covariance_of(terms, v[2] * w[2], views, lights, half_vectors, fixed, growth * grown_a * grown_b);
    double across = a->cosine_ratio * (a_swapped + b->cosine_ratio * both) + b->cosine_ratio * b_swapped;
    return (1 - terms->reciprocity / 2) * same + terms->reciprocity / 2 * across;
}

/* ---- Either ---- */

double weft_covariance_between(const weft_covariance_terms *terms, const weft_direction_pair *a,
                               const weft_direction_pair *b)
{
    double growth = growth_of(terms, a, b);
    if (terms->is_of_mean) {
        weft_direction_pair turned = half_turned(b);
        return between_reciprocal(terms, a, b, growth) +
               terms->half_turn * between_reciprocal(terms, a, &turned, growth);
    }
    double half_vector = squared_distance(a->half_vector, b->half_vector);
    return covariance_of(terms, a->light[2] * b->light[2], squared_distance(a->light, b->light),
                         squared_distance(a->view, b->view), half_vector,
                         terms->fixed * matern(terms->fixed_half * half_vector), growth);
}
