// Columns: the axes that a unit quaternion turns x, y and z to.
mat3 axes_of_quaternion(vec4 q)
{
    vec3 twice = 2.0 * q.xyz;
    vec3 square = twice * q.xyz;
    vec3 mixed = twice.xxy * q.yzz;
    vec3 turned = twice * q.w;
    return mat3(1.0 - square.y - square.z, mixed.x + turned.z, mixed.y - turned.y, //
                mixed.x - turned.z, 1.0 - square.x - square.z, mixed.z + turned.x, //
                mixed.y + turned.y, mixed.z - turned.x, 1.0 - square.x - square.y);
}
