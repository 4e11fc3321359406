// The mean of a weave over its tile, by its kinds of yarn: twin of reflectance/weave/means.c.
// Needs woven.glsl before it, a texture filled by weft_weave_means_of, and defined NOISE: whether it is noisy,
// STAPLES and FILAMENTS: whether it has such yarns. Software rasterisers execute both sides of a branch.
// Common subset of GLSL 3.30 core and GLSL ES 3.00; needs highp float.

const int WEAVE_MEAN_HEADER = 5;
const int WEAVE_MEAN_STEPS = 256;
const int WEAVE_MEAN_NODES = 12;
const float WEAVE_MEAN_MIN_COSINE = 1e-7;

// What the yarns of a row have in common.
struct WeaveKind {
    int row;
    bool warp;
    vec3 colour;
    float umax, alpha, beta, phase_scale, radius, cot_psi, inverse_sin_psi, shape_squared, scale;
    vec2 at_umax; // sine and cosine
};

vec3 weave_mean_diffuse(sampler2D means)
{
    return texelFetch(means, ivec2(1, 0), 0).rgb;
}

WeaveKind weave_kind(sampler2D means, int row)
{
    vec4 head = texelFetch(means, ivec2(0, row), 0);
    vec4 phase = texelFetch(means, ivec2(2, row), 0);
    vec4 shape = texelFetch(means, ivec2(3, row), 0);
    vec4 umax = texelFetch(means, ivec2(4, row), 0);
    return WeaveKind(row, head.w > 0.0, head.rgb, umax.z, phase.x, phase.y, phase.z, phase.w, shape.x, shape.y, shape.z,
                     shape.w, umax.xy);
}

// Radius at u and share of the yarns that are there, both times their fade.
vec2 weave_mean_spine(sampler2D means, WeaveKind kind, float u)
{
    float at = min(abs(u) / kind.umax, 1.0) * float(WEAVE_MEAN_STEPS);
    int step = min(int(at), WEAVE_MEAN_STEPS - 1);
    vec4 ends = texelFetch(means, ivec2(WEAVE_MEAN_HEADER + step, kind.row), 0);
    return mix(ends.xy, ends.zw, at - float(step));
}

vec2 weave_staple_spine(sampler2D means, WeaveKind kind, float sine, float cosine)
{
    if (NOISE)
        return weave_mean_spine(means, kind, atan(sine, cosine));
    float root = inversesqrt(max(cosine * cosine + kind.shape_squared * sine * sine, WEAVE_MEAN_MIN_COSINE));
    return vec2(kind.scale * root * root * root, 1.0);
}

// Of a sum of angles, and 1 from a right angle on; both as sine and cosine, |b| is below one.
float weave_sine_up_to_1(vec2 a, vec2 b)
{
    return a.y * b.y > a.x * b.x ? a.x * b.y + a.y * b.x : 1.0;
}

// Without branches, which cost a rasteriser on the processor more than their arithmetic, and with one division a place:
// c1 + c2 = |H| n.h is the root that the mirroring point needs.
float weave_staple_mean(sampler2D means, WeaveKind kind, vec3 halfway, vec3 light)
{
    float across = sqrt(halfway.y * halfway.y + halfway.z * halfway.z);
    float reach = min(length(halfway) / (kind.inverse_sin_psi * across), 1.0);
    vec2 at_u0 = halfway.yz / across;
    float low = max(-reach, -weave_sine_up_to_1(kind.at_umax, at_u0));
    float high = min(reach, weave_sine_up_to_1(kind.at_umax, vec2(-at_u0.x, at_u0.y)));
    vec3 l = vec3(light.x, dot(light.yz, at_u0), light.y * at_u0.y - light.z * at_u0.x);
    float middle = 0.5 * (low + high);
    float extent = 0.5 * (high - low);
    float angle = WOVEN_PI / float(WEAVE_MEAN_NODES);
    vec2 turn = vec2(cos(angle), sin(angle));
    vec2 theta = vec2(cos(0.5 * angle), sin(0.5 * angle)); // cosine and sine
    float sum = 0.0;
    int count = low < high ? WEAVE_MEAN_NODES : 0;
    for (int i = 0; i < count; i++) {
        float sin_x = middle - extent * theta.x;
        float cos_x = sqrt(max(1.0 - sin_x * sin_x, WEAVE_MEAN_MIN_COSINE));
        float over = across * cos_x;
        float projected = -kind.cot_psi * across * sin_x;
        float square = halfway.x * halfway.x + over * over;
        float sum_square = max(square - projected * projected, 1e-12 * square);
        float cosine_sum = sqrt(sum_square);
        float inverse = 1.0 / (square * sum_square * cos_x);
        float inverse_square = inverse * sum_square * cos_x;
        float sin_v = (halfway.x * cosine_sum - over * projected) * inverse_square;
        float cos_v = (halfway.x * projected + over * cosine_sum) * inverse_square;
        float c1 = sin_v * l.x + cos_v * (cos_x * l.y + sin_x * l.z);
        float shares = max(c1, 0.0) * max(cosine_sum - c1, 0.0) * inverse * square;
        vec2 spine = weave_staple_spine(means, kind, at_u0.x * cos_x + at_u0.y * sin_x, at_u0.y * cos_x - at_u0.x * sin_x);
        sum += cos_v > 0.0 ? theta.y * (spine.x + kind.radius * spine.y * cos_v) * shares : 0.0;
        theta = vec2(theta.x * turn.x - theta.y * turn.y, theta.y * turn.x + theta.x * turn.y);
    }
    return sum * angle * extent * kind.radius * kind.inverse_sin_psi;
}

// Angles round the yarn, from its normal, as sine and cosine.
vec2 weave_sum(vec2 a, vec2 b)
{
    return vec2(a.x * b.y + a.y * b.x, a.y * b.y - a.x * b.x);
}

vec2 weave_difference(vec2 a, vec2 b)
{
    return weave_sum(a, vec2(-b.x, b.y));
}

// tan(pi/4 + w/2), whose logarithm is the integral of 1 / cos w.
float weave_secant_growth(vec2 w)
{
    float cosine = max(w.y, WEAVE_MEAN_MIN_COSINE);
    return w.x >= 0.0 ? (1.0 + w.x) / cosine : cosine / (1.0 - w.x);
}

// The antiderivatives but for their terms in w and its logarithms.
vec2 weave_end(vec2 w, vec2 turn, vec2 middle)
{
    return vec2(weave_sum(w, turn).x, 0.25 * weave_sum(weave_sum(w, w), weave_sum(middle, turn)).x);
}

// Integrals round the yarn of c1 c2 / (c1 + c2) and of that times cos v, over the v that face both directions.
vec2 weave_integrate_round(vec2 l, vec2 m, vec2 h)
{
    bool l_is_less = weave_difference(l, m).x <= 0.0;
    vec2 least = l_is_less ? l : m;
    vec2 greatest = l_is_less ? m : l;
    vec2 high = least.x >= 0.0 ? vec2(1.0, 0.0) : vec2(least.y, -least.x);
    vec2 low = greatest.x <= 0.0 ? vec2(-1.0, 0.0) : vec2(-greatest.y, greatest.x);
    vec2 range = weave_difference(high, low);
    vec2 a = weave_difference(h, l);
    vec2 b = weave_difference(h, m);
    vec2 turn = weave_sum(a, b);
    if (!(range.x >= 0.0))
        return vec2(0.0);
    float width = range.x == 0.0 && range.y == 0.0 ? 0.0 : atan(range.x, range.y);
    float both = a.x * b.x;
    vec2 first = weave_difference(low, h);
    vec2 last = weave_difference(high, h);
    float ratio = max(last.y, WEAVE_MEAN_MIN_COSINE) / max(first.y, WEAVE_MEAN_MIN_COSINE);
    vec2 sum = weave_end(last, turn, h) - weave_end(first, turn, h);
    sum.x += both * log(weave_secant_growth(last) / weave_secant_growth(first));
    sum.y += width * (0.5 * weave_difference(h, turn).y + both * h.y) + both * h.x * log(ratio);
    return sum;
}

float weave_filament_mean(sampler2D means, WeaveKind kind, vec3 halfway, vec3 light, vec3 view)
{
    float across = sqrt(halfway.y * halfway.y + halfway.z * halfway.z);
    float u = atan(halfway.y, halfway.z);
    if (!(across > WOVEN_MIN_ACROSS && abs(u) < kind.umax))
        return 0.0;
    vec2 at = halfway.yz / across;
    vec2 l = vec2(light.x, dot(light.yz, at));
    vec2 m = vec2(view.x, dot(view.yz, at));
    vec2 h = vec2(halfway.x, across);
    vec3 lengths = max(vec3(length(l), length(m), length(h)), WOVEN_MIN_ACROSS);
    vec2 sum = weave_integrate_round(l / lengths.x, m / lengths.y, h / lengths.z);
    vec2 spine = weave_mean_spine(means, kind, u);
    float value = kind.radius * (spine.x * sum.x + kind.radius * spine.y * sum.y);
    return max(value * lengths.x * lengths.y / (lengths.z * across), 0.0);
}

// What a kind adds to the mean; light and view in the frame of the cloth.
vec3 weave_mean_of_kind(sampler2D means, WeaveKind kind, vec3 light, vec3 view)
{
    vec3 l = kind.warp ? light : vec3(-light.y, light.x, light.z);
    vec3 v = kind.warp ? view : vec3(-view.y, view.x, view.z);
    vec3 halfway = l + v;
    bool shines = kind.umax > 0.0 && light.z > 0.0 && view.z > 0.0 && dot(halfway, halfway) >= WOVEN_MIN_HALF_SQUARED;
    if (!shines)
        return vec3(0.0);
    bool is_filament = FILAMENTS && (!STAPLES || kind.inverse_sin_psi == 0.0);
    float value =
        is_filament ? weave_filament_mean(means, kind, halfway, l, v) : weave_staple_mean(means, kind, halfway, l);
    float x = clamp(-dot(light, view), -1.0, 1.0);
    float phase = kind.alpha + exp(kind.beta * x - abs(kind.beta)) * kind.phase_scale;
    return kind.colour * (value * phase);
}
