// Barycentric lookup in a spherical triangulation by walking from simplex to simplex.
// C twin: weft_triangulation_lookup; the layout of the textures is player/texture/direction_map.h.
uniform sampler2D direction_simplex;
uniform isampler2D direction_cell;

const int DIRECTION_GRID = 64;
const int DIRECTION_SETS_PER_ROW = 64;
const int DIRECTION_SIMPLICES_PER_ROW = 256;
const int DIRECTION_MAX_STEPS = 48;

struct Corners {
    ivec3 label;
    vec3 weight; // >= 0, sum 1
};

vec4 simplex_entry(int simplex, int column)
{
    int row = simplex / DIRECTION_SIMPLICES_PER_ROW;
    vec2 place = vec2(4 * (simplex - row * DIRECTION_SIMPLICES_PER_ROW) + column, row) + 0.5;
    return textureLod(direction_simplex, place / vec2(textureSize(direction_simplex, 0)), 0.0);
}

int first_simplex(int set, vec3 direction)
{
    vec2 flat_position = direction.xy / (abs(direction.x) + abs(direction.y) + max(direction.z, 0.0));
    vec2 square = 0.5 + 0.5 * vec2(flat_position.x + flat_position.y, flat_position.x - flat_position.y);
    ivec2 cell = clamp(ivec2(square * float(DIRECTION_GRID)), 0, DIRECTION_GRID - 1);
    int row = set / DIRECTION_SETS_PER_ROW;
    ivec2 map = ivec2(set - row * DIRECTION_SETS_PER_ROW, row) * DIRECTION_GRID;
    return textureLod(direction_cell, (vec2(map + cell) + 0.5) / vec2(textureSize(direction_cell, 0)), 0.0).r;
}

float smallest_of(vec3 weight)
{
    return min(weight.x, min(weight.y, weight.z));
}

Corners find_corners(int set, vec3 query)
{
    int simplex = first_simplex(set, query);
    int previous = -1;
    vec4 a, b, c;
    vec3 weight;
    for (int i = 0; i < DIRECTION_MAX_STEPS; i++) {
        a = simplex_entry(simplex, 0);
        b = simplex_entry(simplex, 1);
        c = simplex_entry(simplex, 2);
        weight = query * mat3(a.xyz, b.xyz, c.xyz);
        vec4 next = simplex_entry(simplex, 3);
        float smallest = smallest_of(weight);
        int target = int(smallest == weight.x ? next.x : smallest == weight.y ? next.y : next.z);
        // Found; or sent back: the query lies on the border of the two, within rounding.
        if (smallest >= 0.0 || target < 0 || target == previous)
            break;
        previous = simplex;
        simplex = target;
    }
    bool arc = c.w < 0.0;
    weight = max(arc ? vec3(weight.xy, 0.0) : weight, vec3(0.0));
    float sum = weight.x + weight.y + weight.z;
    weight = sum > 0.0 ? weight / sum : vec3(1.0, 0.0, 0.0);
    return Corners(ivec3(int(a.w), int(b.w), int(arc ? b.w : c.w)), weight);
}
