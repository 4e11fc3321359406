/* Gaussians of the lighting of microcylinder cloth. */
#include "bench/numerics/take.h"
#include "reflectance/gaussian/spherical_gaussian.h"

numerics_value numerics_spherical_gaussian(const double *a)
{
    weft_vec3 direction = take_direction(&a), centre = take_direction(&a);
    return plain_value(weft_spherical_gaussian(direction, centre, take(&a)));
}

numerics_value numerics_circular_gaussian(const double *a)
{
    weft_real mean = take(&a), width = take(&a), x = take(&a);
    return plain_value(weft_circular_gaussian(x, mean, width));
}

static weft_circular_lobe product_of(const double *a)
{
    weft_real mean1 = take(&a), width1 = take(&a), mean2 = take(&a), width2 = take(&a);
    return weft_circular_product(mean1, width1, mean2, width2);
}

numerics_value numerics_product_scale(const double *a)
{
    return plain_value(product_of(a).scale);
}

numerics_value numerics_product_width(const double *a)
{
    return plain_value(product_of(a).width);
}

numerics_value numerics_split_width(const double *a)
{
    weft_vec3 direction = take_direction(&a), centre = take_direction(&a);
    return plain_value(weft_spherical_gaussian_split(direction, centre, take(&a)).phi_width);
}

numerics_value numerics_gaussian_box(const double *a)
{
    weft_real theta_mean = take(&a), phi_mean = take(&a), theta_width = take(&a), phi_width = take(&a);
    return scaled_value(weft_gaussian_box(theta_mean, theta_width, phi_mean, phi_width),
                        (weft_real)WEFT_PI * theta_width * phi_width);
}

numerics_value numerics_half_plane(const double *a)
{
    weft_real theta_width = take(&a), phi_width = take(&a), distance = take(&a), gamma = take(&a);
    return scaled_value(weft_gaussian_half_plane(theta_width, phi_width, distance, gamma), 1);
}

numerics_value numerics_sigmoid(const double *a)
{
    weft_real gain = take(&a), distance = take(&a);
    return plain_value(weft_sigmoid(gain, distance));
}
