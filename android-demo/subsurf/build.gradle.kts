import com.android.build.api.dsl.LibraryExtension

plugins {
    alias(libs.plugins.android.library)
}

val abis = listOf("arm64-v8a", "armeabi-v7a", "x86_64")
val repository = rootProject.layout.projectDirectory.dir("..")
val jniLibs = layout.buildDirectory.dir("rust/jniLibs")

configure<LibraryExtension> {
    namespace = "dev.subsurf"
    compileSdk = libs.versions.compileSdk.get().toInt()
    ndkVersion = libs.versions.ndk.get()

    defaultConfig {
        minSdk = libs.versions.minSdk.get().toInt()
        consumerProguardFiles("consumer-rules.pro")
        testInstrumentationRunner = "androidx.test.runner.AndroidJUnitRunner"
        ndk { abiFilters += abis }
    }

    compileOptions {
        sourceCompatibility = JavaVersion.VERSION_17
        targetCompatibility = JavaVersion.VERSION_17
    }

    sourceSets {
        // What needs no Android is in src/plain; its tests run on any JVM, see host-tests.
        named("main") {
            kotlin.directories += "src/plain/kotlin"
            jniLibs.directories += "build/rust/jniLibs"
        }
        // Measurements that devices and host share.
        named("androidTest") {
            kotlin.directories += "src/sharedTest/kotlin"
            assets.directories += "../app/build/materials"
        }
    }

    androidResources { noCompress += "subsurf" }
}

kotlin {
    explicitApi()
    compilerOptions {
        allWarningsAsErrors = true
    }
}

// The library in Rust, for every ABI: pages of 16 KB, as Android 15 and Play want them; cargo finds what is stale.
val cargoNdk =
    tasks.register<Exec>("cargoNdk") {
        description = "Builds libsubsurf.so with cargo-ndk (cargo install cargo-ndk --version 4.1.2)"
        workingDir = repository.asFile
        val ndk = androidComponents.sdkComponents.ndkDirectory
        val output = jniLibs
        val minSdk = libs.versions.minSdk.get()
        doFirst { environment("ANDROID_NDK_HOME", ndk.get().asFile.path) }
        commandLine(
            listOf("cargo", "ndk") + abis.flatMap { listOf("--target", it) } +
                listOf("--platform", minSdk, "--output-dir", output.get().asFile.path) +
                listOf("rustc", "--locked", "--profile", "bindings", "--package", "subsurf-c-runtime", "--crate-type", "cdylib", "--") +
                // As scripts/android has it, for size.
                listOf("--icf=all", "--pack-dyn-relocs=android").flatMap { listOf("-C", "link-arg=-Wl,$it") },
        )
        outputs.dir(output)
        outputs.upToDateWhen { false }
    }

tasks.named("preBuild") { dependsOn(cargoNdk) }

// The C API for apps with code of their own in C or C++: find_package(subsurf) in CMake, by Prefab. The plugin makes such packages of
// its own builds of C alone.
val prefab =
    tasks.register<Sync>("prefab") {
        dependsOn(cargoNdk)
        into(layout.buildDirectory.dir("rust/prefab"))
        from("src/prefab")
        from(repository.dir("bindings/include")) { into("modules/subsurf/include") }
        for (abi in abis) {
            from(jniLibs.map { it.dir(abi) }) {
                include("libsubsurf.so")
                into("modules/subsurf/libs/android.$abi")
            }
        }
    }

tasks.withType<Zip>().matching { it.name.startsWith("bundle") && it.name.endsWith("Aar") }.configureEach {
    from(prefab) { into("prefab") }
}

tasks.matching { it.name.startsWith("merge") && it.name.endsWith("AndroidTestAssets") }.configureEach {
    dependsOn(":app:encodeMaterials")
}

dependencies {
    api(libs.coroutines.core)
    androidTestImplementation(libs.junit)
    androidTestImplementation(libs.androidx.junit)
    androidTestImplementation(libs.androidx.runner)
}
