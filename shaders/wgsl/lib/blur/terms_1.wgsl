// One weighted irradiance map, L = 1: a plain texture, and targets of the passes that draw it.

const TERMS: u32 = 1u;

alias TargetMaps = TargetTexture;

struct Maps {
    @location(0) first: TargetTexel,
}

struct MapsAndSums {
    @location(0) first: TargetTexel,
    @location(1) first_sum: TargetTexel,
}

// Map l at a texel.
fn load_map(maps: TargetMaps, texel: vec2<i32>, l: u32) -> vec4<f32> {
    return unpack(textureLoad(maps, texel, 0));
}

// Targets for the maps.
fn maps_of(maps: array<vec4<f32>, TERMS>) -> Maps {
    return Maps(pack(maps[0]));
}

// Targets for the maps and the sums.
fn maps_and_sums_of(maps: array<vec4<f32>, TERMS>, sums: array<vec4<f32>, TERMS>) -> MapsAndSums {
    return MapsAndSums(pack(maps[0]), pack(sums[0]));
}
