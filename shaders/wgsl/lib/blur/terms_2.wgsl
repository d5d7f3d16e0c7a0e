// Two weighted irradiance maps, L = 2: layers of a texture, and targets of the passes that draw them.

const TERMS: u32 = 2u;

alias TargetMaps = TargetTextureArray;

struct Maps {
    @location(0) first: TargetTexel,
    @location(1) second: TargetTexel,
}

struct MapsAndSums {
    @location(0) first: TargetTexel,
    @location(1) second: TargetTexel,
    @location(2) first_sum: TargetTexel,
    @location(3) second_sum: TargetTexel,
}

// Map l at a texel.
fn load_map(maps: TargetMaps, texel: vec2<i32>, l: u32) -> vec4<f32> {
    return unpack(textureLoad(maps, texel, l, 0));
}

// Targets for the maps.
fn maps_of(maps: array<vec4<f32>, TERMS>) -> Maps {
    return Maps(pack(maps[0]), pack(maps[1]));
}

// Targets for the maps and the sums.
fn maps_and_sums_of(maps: array<vec4<f32>, TERMS>, sums: array<vec4<f32>, TERMS>) -> MapsAndSums {
    return MapsAndSums(pack(maps[0]), pack(maps[1]), pack(sums[0]), pack(sums[1]));
}
