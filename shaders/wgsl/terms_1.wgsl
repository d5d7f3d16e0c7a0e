// One weighted irradiance map.
const TERMS: u32 = 1u;

struct Maps {
    @location(0) first: vec4<f32>,
}

struct MapsAndSums {
    @location(0) first: vec4<f32>,
    @location(1) first_sum: vec4<f32>,
}

fn maps_of(maps: array<vec4<f32>, TERMS>) -> Maps {
    return Maps(maps[0]);
}

fn maps_and_sums_of(maps: array<vec4<f32>, TERMS>, sums: array<vec4<f32>, TERMS>) -> MapsAndSums {
    return MapsAndSums(maps[0], sums[0]);
}
