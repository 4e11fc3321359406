// Spherical and circular Gaussians: twin of reflectance/gaussian/spherical_gaussian.c, without the integrals, which tables hold.
// Common subset of GLSL 3.30 core and GLSL ES 3.00; needs highp float.

const float GAUSSIAN_MIN_WIDTH = 1e-9;
const float GAUSSIAN_INFINITE_WIDTH = 1e18; // stands for infinity: such a Gaussian is 1 everywhere

struct CircularLobe {
    float mean, width, scale;
};

struct GaussianSplit {
    float theta, theta_centre, phi, phi_centre, phi_width;
};

float gaussian_of(float x, float width)
{
    float scaled = x / max(width, GAUSSIAN_MIN_WIDTH);
    return exp(-scaled * scaled);
}

float spherical_gaussian(vec3 direction, vec3 centre, float width)
{
    return gaussian_of(length(direction - centre), width);
}

float circular_gaussian(float x, float mean, float width)
{
    return gaussian_of(2.0 * sin(0.5 * (x - mean)), width);
}

// Into -pi..pi.
float wrapped_angle(float angle)
{
    const float turn = 6.28318530717959;
    return angle - turn * floor(angle / turn + 0.5);
}

// atan(0, 0) is undefined in GLSL.
float gaussian_angle(float y, float x)
{
    return x == 0.0 && y == 0.0 ? 0.0 : atan(y, x);
}

CircularLobe narrow_first(float mean1, float width1, float mean2, float width2)
{
    float quotient = width2 >= GAUSSIAN_INFINITE_WIDTH ? 0.0 : width1 / width2;
    float ratio = quotient * quotient;
    float sine = sin(0.5 * (mean2 - mean1));
    float cosine = cos(0.5 * (mean2 - mean1));
    float excess = (1.0 - quotient) * (1.0 + quotient);
    float total = sqrt(excess * excess + 4.0 * ratio * cosine * cosine);
    if (!(total > 0.0))
        return CircularLobe(0.0, GAUSSIAN_INFINITE_WIDTH, gaussian_of(2.0, width1));
    float turn = gaussian_angle(2.0 * ratio * sine * cosine, excess + 2.0 * ratio * cosine * cosine);
    float distance = 2.0 * sine * quotient * sqrt(2.0 / (total + 1.0 + ratio));
    return CircularLobe(wrapped_angle(mean1 + turn), width1 / sqrt(total), gaussian_of(distance, width1));
}

CircularLobe circular_product(float mean1, float width1, float mean2, float width2)
{
    width1 = max(width1, GAUSSIAN_MIN_WIDTH);
    width2 = max(width2, GAUSSIAN_MIN_WIDTH);
    if (width1 >= GAUSSIAN_INFINITE_WIDTH && width2 >= GAUSSIAN_INFINITE_WIDTH)
        return CircularLobe(0.0, GAUSSIAN_INFINITE_WIDTH, 1.0);
    return width1 <= width2 ? narrow_first(mean1, width1, mean2, width2) : narrow_first(mean2, width2, mean1, width1);
}

GaussianSplit spherical_gaussian_split(vec3 direction, vec3 centre, float width)
{
    float cosine = length(direction.yz);
    float centre_cosine = length(centre.yz);
    float both = sqrt(cosine) * sqrt(centre_cosine);
    return GaussianSplit(gaussian_angle(direction.x, cosine), gaussian_angle(centre.x, centre_cosine),
                         gaussian_angle(direction.z, direction.y), gaussian_angle(centre.z, centre.y),
                         both > 0.0 ? width / both : GAUSSIAN_INFINITE_WIDTH);
}

float gaussian_sigmoid(float gain, float distance)
{
    float x = gain * distance;
    float e = exp(-abs(x));
    return x >= 0.0 ? 1.0 / (1.0 + e) : e / (1.0 + e);
}
