import com.android.build.api.dsl.ApplicationExtension

plugins {
    alias(libs.plugins.android.application)
}

val repository = rootProject.layout.projectDirectory.dir("..")
val materials = layout.buildDirectory.dir("materials")

configure<ApplicationExtension> {
    namespace = "dev.subsurf.demo"
    compileSdk = libs.versions.compileSdk.get().toInt()
    ndkVersion = libs.versions.ndk.get()

    defaultConfig {
        applicationId = "dev.subsurf.demo"
        minSdk = libs.versions.minSdk.get().toInt()
        targetSdk = libs.versions.compileSdk.get().toInt()
        versionCode = 1
        versionName = "0.1.0"
    }

    buildTypes {
        release {
            isMinifyEnabled = true
            isShrinkResources = true
            proguardFiles(getDefaultProguardFile("proguard-android-optimize.txt"))
            // A key of one's own signs what is given away; this one is for phones at hand.
            signingConfig = signingConfigs.getByName("debug")
        }
    }

    compileOptions {
        sourceCompatibility = JavaVersion.VERSION_17
        targetCompatibility = JavaVersion.VERSION_17
    }

    sourceSets {
        named("main") { assets.directories += "build/materials" }
    }

    // Assets are mapped where they lie in the APK.
    androidResources { noCompress += "subsurf" }
}

kotlin {
    compilerOptions {
        allWarningsAsErrors = true
    }
}

// Materials of the demo, simulated and encoded by this project's own command.
val encodeMaterials =
    tasks.register<Exec>("encodeMaterials") {
        workingDir = repository.asFile
        val output = materials
        commandLine("android-demo/materials", output.get().asFile.path)
        inputs.file("../materials")
        outputs.dir(output)
    }

tasks.named("preBuild") { dependsOn(encodeMaterials) }

dependencies {
    implementation(project(":subsurf"))
}
