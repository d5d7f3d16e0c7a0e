import com.android.build.api.dsl.LibraryExtension

plugins {
    alias(libs.plugins.android.library)
}

val abis = listOf("arm64-v8a", "armeabi-v7a", "x86_64")

// Their names in Rust, in the same order.
val triples = listOf("aarch64-linux-android", "armv7-linux-androideabi", "x86_64-linux-android")
val repository = rootProject.layout.projectDirectory.dir("..")
val jniLibs = layout.buildDirectory.dir("rust/jniLibs")
val testPrograms = layout.buildDirectory.dir("rust/testPrograms")

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
            jniLibs.directories += "build/rust/testPrograms"
        }
    }

    // Programs run from files alone: the test app's libraries are unpacked when it is installed.
    packaging { jniLibs { useLegacyPackaging = true } }

    androidResources { noCompress += "subsurf" }
}

kotlin {
    explicitApi()
    compilerOptions {
        allWarningsAsErrors = true
    }
}

// Runs cargo-ndk for every ABI; cargo finds what is stale.
fun Exec.runCargoNdk(vararg arguments: String) {
    workingDir = repository.asFile
    val ndk = androidComponents.sdkComponents.ndkDirectory
    doFirst { environment("ANDROID_NDK_HOME", ndk.get().asFile.path) }
    val targets = abis.flatMap { listOf("--target", it) } + listOf("--platform", libs.versions.minSdk.get())
    commandLine(listOf("cargo", "ndk") + targets + arguments)
    outputs.upToDateWhen { false }
}

// The library in Rust: pages of 16 KB, as Android 15 and Play want them.
val cargoNdk =
    tasks.register<Exec>("cargoNdk") {
        description = "Builds libsubsurf.so with cargo-ndk (cargo install cargo-ndk --version 4.1.2)"
        // As scripts/android has it, for size.
        val small = listOf("--icf=all", "--pack-dyn-relocs=android", "--hash-style=gnu").flatMap { listOf("-C", "link-arg=-Wl,$it") }
        val library = arrayOf("--package", "subsurf-c-runtime", "--crate-type", "cdylib", "--", *small.toTypedArray())
        val output = jniLibs.get().asFile.path
        runCargoNdk("--output-dir", output, "rustc", "--locked", "--profile", "bindings", *library)
        outputs.dir(output)
    }

// The program load_test, under the name of a library, as test apps carry programs.
val cargoNdkLoadTest =
    tasks.register<Exec>("cargoNdkLoadTest") {
        description = "Builds load_test with cargo-ndk"
        runCargoNdk("build", "--locked", "--profile", "bindings", "--package", "subsurf-c-draw", "--example", "load_test")
    }

val loadTest =
    tasks.register<Sync>("loadTest") {
        dependsOn(cargoNdkLoadTest)
        into(testPrograms)
        for ((abi, triple) in abis.zip(triples)) {
            from(repository.file("target/$triple/bindings/examples/load_test")) {
                into(abi)
                rename { "libload_test.so" }
            }
        }
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

tasks.matching { it.name.startsWith("merge") && it.name.endsWith("AndroidTestJniLibFolders") }.configureEach {
    dependsOn(loadTest)
}

dependencies {
    api(libs.coroutines.core)
    androidTestImplementation(libs.junit)
    androidTestImplementation(libs.androidx.junit)
    androidTestImplementation(libs.androidx.runner)
}
