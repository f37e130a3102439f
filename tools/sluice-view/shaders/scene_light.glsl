// Shading by one light and a sky, without images. Metalness and roughness follow glTF 2.0, appendix B.
const vec3 lightDirection = normalize(vec3(0.35, 0.8, 0.5));
const vec3 lightColor = vec3(1.5), skyColor = vec3(0.62, 0.68, 0.76), groundColor = vec3(0.40, 0.38, 0.36);

/* Light of the sky from a direction. Rough surfaces average over directions. */
vec3 skyLight(vec3 direction, float roughness)
{
    float up = 0.5 + 0.5 * direction.y;
    float edge = mix(0.08, 0.5, roughness);
    return mix(groundColor, skyColor, smoothstep(0.5 - edge, 0.5 + edge, up));
}

/* Reflection of the sky. Karis: "Physically Based Shading on Mobile", 2014. */
vec3 skyReflection(vec3 f0, float roughness, float facing)
{
    vec4 r = roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
    float a = min(r.x * r.x, exp2(-9.28 * facing)) * r.x + r.y;
    vec2 ab = vec2(-1.04, 1.04) * a + r.zw;
    return f0 * ab.x + ab.y;
}

vec3 shade(vec3 color, float metalness, float roughness, vec3 normal, vec3 toEye, float open)
{
    vec3 f0 = mix(vec3(0.04), color, metalness), diffuse = color * (1.0 - metalness);
    vec3 middle = normalize(lightDirection + toEye);
    float facing = max(dot(normal, toEye), 1e-3), lit = max(dot(normal, lightDirection), 0.0);
    float a = max(roughness * roughness, 2e-3), nh = max(dot(normal, middle), 0.0);
    float spread = nh * nh * (a * a - 1.0) + 1.0;
    float peaks = a * a / (3.14159265 * spread * spread);
    float seen = 0.5 / max(mix(2.0 * lit * facing, lit + facing, a), 1e-4);
    vec3 fresnel = f0 + (1.0 - f0) * pow(1.0 - max(dot(toEye, middle), 0.0), 5.0);
    vec3 direct = (diffuse * (1.0 - fresnel) / 3.14159265 + fresnel * peaks * seen) * lit * lightColor;
    vec3 around = diffuse * skyLight(normal, 1.0) +
                  skyReflection(f0, roughness, facing) * skyLight(reflect(-toEye, normal), roughness);
    return direct + around * open;
}
