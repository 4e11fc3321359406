// Satin from one measurement under light along the normal (BARD): twin of reflectance/bard/bard.c.
// Common subset of GLSL 3.30 core and GLSL ES 3.00; needs highp float.

const float BARD_PI = 3.14159265;
// sin of 3 degrees, and 3 degrees: lights below this elevation are treated as if they stood at it.
const float BARD_MIN_SINE = 0.0523359562;
const float BARD_MIN_ELEVATION = 0.0523598776;

struct BardPoint {
    vec3 direction; // where to look up
    float gain;     // 1 / cos^2 of the inclination of the light
};

// atan(y, x) has no value for (0, 0) in GLSL.
float bard_atan(float y, float x)
{
    return x == 0.0 && y == 0.0 ? 0.0 : atan(y, x);
}

// beta, beta_o, cos beta_o, sin beta_o for the view in the axes of the projection.
vec4 bard_turn(float elevation, vec3 view)
{
    float across = length(view.yz), beta = bard_atan(across, view.x);
    if (beta <= elevation) {
        float beta_o = beta * (0.5 * BARD_PI) / elevation;
        return vec4(beta, beta_o, cos(beta_o), sin(beta_o));
    }
    float rest = bard_atan(across, -view.x) * (0.5 * BARD_PI) / (BARD_PI - elevation);
    return vec4(beta, BARD_PI - rest, -cos(rest), sin(rest));
}

vec3 bard_turned_in_plane(vec4 turn, vec3 view)
{
    float across = length(view.yz);
    return vec3(turn.z, across > 0.0 ? turn.w * (view.yz / across) : vec2(0.0));
}

vec3 bard_scaled_angles(vec4 turn, vec3 view)
{
    float ratio = turn.x > 0.0 ? turn.y / turn.x : 1.0;
    float elevation = ratio * bard_atan(view.z, length(view.xy)), azimuth = ratio * bard_atan(view.y, view.x);
    return vec3(cos(elevation) * cos(azimuth), cos(elevation) * sin(azimuth), sin(elevation));
}

BardPoint bard_locate(bool printed, vec3 light, vec3 view)
{
    float along = length(light.xy), cosine = max(light.z, BARD_MIN_SINE), gain = 1.0 / (cosine * cosine);
    if (!(along >= 1e-9))
        return BardPoint(view, gain);
    vec2 axis = -light.xy / along;
    vec3 local = vec3(dot(view.xy, axis), view.y * axis.x - view.x * axis.y, view.z);
    vec4 turn = bard_turn(max(bard_atan(light.z, along), BARD_MIN_ELEVATION), local);
    local = printed ? bard_scaled_angles(turn, local) : bard_turned_in_plane(turn, local);
    return BardPoint(vec3(local.x * axis - local.y * vec2(axis.y, -axis.x), local.z), gain);
}

// One row of the grid; `column` in [0, columns].
float bard_row(sampler2D table, int row, float column, int columns)
{
    int left = int(column);
    float a = texelFetch(table, ivec2(left % columns, row), 0).r;
    float b = texelFetch(table, ivec2((left + 1) % columns, row), 0).r;
    return mix(a, b, column - float(left));
}

// BRDF under light along the normal: rows are theta from 0 to 90 degrees, columns phi from 0 round.
float bard_grid_lookup(sampler2D table, vec3 direction)
{
    ivec2 size = textureSize(table, 0);
    float theta = min(bard_atan(length(direction.xy), direction.z), 0.5 * BARD_PI);
    float turns = bard_atan(direction.y, direction.x) / (2.0 * BARD_PI);
    float row = theta / (0.5 * BARD_PI) * float(size.y - 1);
    float column = (turns < 0.0 ? turns + 1.0 : turns) * float(size.x);
    int upper = min(int(row), size.y - 2);
    return mix(bard_row(table, upper, column, size.x), bard_row(table, upper + 1, column, size.x), row - float(upper));
}

// rho_d / pi + gain * table, 1/sr; 0 below the horizon.
float bard_brdf(bool printed, float rho_d, sampler2D table, vec3 light, vec3 view)
{
    if (!(light.z > 0.0 && view.z > 0.0))
        return 0.0;
    BardPoint point = bard_locate(printed, light, view);
    return rho_d / BARD_PI + point.gain * bard_grid_lookup(table, point.direction);
}
