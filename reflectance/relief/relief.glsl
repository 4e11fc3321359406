// Photographs seen through the heights of the surface. C twin: reflectance/relief/relief.c, which has the reasons.
uniform sampler2D relief_height;     // a share of the range of heights; the material repeats
uniform sampler2DArray relief_seen;  // the same as every stored view sees it
uniform sampler2D relief_slope;      // of every stored view
uniform vec2 relief_range;           // the lowest and the highest, mm
uniform vec2 relief_size;            // of the material, mm
uniform float relief_levels;         // the finest levels on which heights count

const int RELIEF_STEPS = 16;
const int RELIEF_BISECTIONS = 3;
const float RELIEF_LEAST_COSINE = 0.2;
const float RELIEF_HALF_HIDDEN = 0.12;
const float RELIEF_LEAST_VISIBILITY = 1e-3;

struct ReliefTap {
    vec2 coordinate;
    float weight;
};

// How much of a value at `level` is seen through the heights.
float relief_share(float level)
{
    return clamp(relief_levels - level, 0.0, 1.0);
}

vec2 relief_slope_of(vec3 view)
{
    return view.xy / (max(view.z, RELIEF_LEAST_COSINE) * relief_size);
}

// How far the sight line lies above the surface at a height.
float relief_clearance(vec2 coordinate, vec2 slope, float height)
{
    vec2 at = coordinate + height * slope;
    return height - mix(relief_range.x, relief_range.y, textureLod(relief_height, vec2(at.x, -at.y), 0.0).r);
}

float relief_march(vec2 coordinate, vec2 slope)
{
    float low = relief_range.x, high = relief_range.y, size = (high - low) / float(RELIEF_STEPS);
    float above = high, above_by = relief_clearance(coordinate, slope, high);
    if (above_by <= 0.0 || size <= 0.0)
        return high;
    float below = above, below_by = above_by;
    for (int i = 1; i <= RELIEF_STEPS && below_by > 0.0; i++) {
        above = below;
        above_by = below_by;
        below = high - float(i) * size;
        below_by = relief_clearance(coordinate, slope, below);
    }
    if (below_by > 0.0)
        return low;
    for (int i = 0; i < RELIEF_BISECTIONS; i++) {
        float middle = 0.5 * (above + below), middle_by = relief_clearance(coordinate, slope, middle);
        if (middle_by > 0.0) {
            above = middle;
            above_by = middle_by;
        } else {
            below = middle;
            below_by = middle_by;
        }
    }
    return above + (below - above) * above_by / (above_by - below_by);
}

float relief_visibility(float seen, float point)
{
    float above = max(seen - point, 0.0) / RELIEF_HALF_HIDDEN;
    return max(1.0 / (1.0 + above * above), RELIEF_LEAST_VISIBILITY);
}

// `number` counts the stored views from 0.
void relief_taps(float share, vec2 coordinate, vec3 view, ivec3 number, vec3 weight, out ReliefTap tap[3])
{
    vec2 slope = share * relief_slope_of(view);
    float height = relief_march(coordinate, slope), range = relief_range.y - relief_range.x, sum = 0.0;
    float point = range > 0.0 ? (height - relief_range.x) / range : 0.0;
    for (int i = 0; i < 3; i++) {
        tap[i] = ReliefTap(coordinate, 0.0);
        if (weight[i] <= 0.0)
            continue;
        vec2 at = coordinate + height * (slope - share * texelFetch(relief_slope, ivec2(number[i], 0), 0).xy);
        float seen = textureLod(relief_seen, vec3(at.x, -at.y, float(number[i])), 0.0).r;
        tap[i] = ReliefTap(at, weight[i] * relief_visibility(seen, point));
        sum += tap[i].weight;
    }
    for (int i = 0; i < 3; i++)
        tap[i].weight = sum > 0.0 ? tap[i].weight / sum : 0.0;
}
