// A frame of fewer pixels as one of more: by Mitchell and Netravali's filter (1988), which blurs little, held between the
// four pixels around, so that no dark line runs beside bright cloth.
in vec2 screen;
uniform sampler2D frame;
uniform vec2 drawn;   // pixels of the frame, from the lower left corner of its texture
uniform vec2 enlarged; // pixels of the picture
out vec4 colour;

// Of the four pixels around a place `t` of the way from the second to the third.
vec4 weights_at(float t)
{
    vec4 power = vec4(1.0, t, t * t, t * t * t);
    return power * mat4(1.0, -9.0, 15.0, -7.0, //
                        16.0, 0.0, -36.0, 21.0, //
                        1.0, 9.0, 27.0, -21.0, //
                        0.0, 0.0, -6.0, 7.0) / 18.0;
}

void main()
{
    vec2 at = gl_FragCoord.xy / enlarged * drawn - 0.5;
    vec2 corner = floor(at), size = vec2(textureSize(frame, 0));
    vec4 across = weights_at(at.x - corner.x), up = weights_at(at.y - corner.y);
    vec4 x = (clamp(corner.x + vec4(-1.0, 0.0, 1.0, 2.0), 0.0, drawn.x - 1.0) + 0.5) / size.x;
    vec4 y = (clamp(corner.y + vec4(-1.0, 0.0, 1.0, 2.0), 0.0, drawn.y - 1.0) + 0.5) / size.y;
    vec3 sum = vec3(0.0), least = vec3(1e30), most = vec3(-1e30);
    for (int i = 0; i < 4; i++) {
        vec3 left = textureLod(frame, vec2(x.y, y[i]), 0.0).rgb, right = textureLod(frame, vec2(x.z, y[i]), 0.0).rgb;
        vec3 row = across.x * textureLod(frame, vec2(x.x, y[i]), 0.0).rgb + across.y * left + across.z * right +
                   across.w * textureLod(frame, vec2(x.w, y[i]), 0.0).rgb;
        sum += up[i] * row;
        if (i == 1 || i == 2) {
            least = min(least, min(left, right));
            most = max(most, max(left, right));
        }
    }
    colour = vec4(clamp(sum, least, most), 1.0);
}
