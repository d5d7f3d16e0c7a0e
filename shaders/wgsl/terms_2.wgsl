// Two weighted irradiance maps.
const TERMS: u32 = 2u;

struct Maps {
    @location(0) first: vec4<f32>,
    @location(1) second: vec4<f32>,
}

struct MapsAndSums {
    @location(0) first: vec4<f32>,
    @location(1) second: vec4<f32>,
    @location(2) first_sum: vec4<f32>,
    @location(3) second_sum: vec4<f32>,
}

fn maps_of(maps: array<vec4<f32>, TERMS>) -> Maps {
    return Maps(maps[0], maps[1]);
}

fn maps_and_sums_of(maps: array<vec4<f32>, TERMS>, sums: array<vec4<f32>, TERMS>) -> MapsAndSums {
    return MapsAndSums(maps[0], maps[1], sums[0], sums[1]);
}
