package dev.subsurf.android

import android.app.Activity
import android.view.View
import dev.subsurf.Backend
import dev.subsurf.R
import dev.subsurf.SubsurfView
import dev.subsurf.Technique
import org.junit.Assert.assertEquals
import org.junit.Assert.assertFalse
import org.junit.Assert.assertNotNull
import org.junit.Test
import org.junit.experimental.categories.Category
import org.junit.runner.RunWith
import org.robolectric.Robolectric
import org.robolectric.RobolectricTestRunner
import org.robolectric.annotation.Config

/** Attributes of a view in XML, by the resources that aapt2 made, and assets. */
@RunWith(RobolectricTestRunner::class)
@Category(OnAndroid::class)
@Config(sdk = [35])
class AttributesTest {
    @Test
    @Suppress("DEPRECATION")
    fun attributesAreTakenAndTheAssetIsShown() {
        val attributes =
            Robolectric.buildAttributeSet()
                .addAttribute(R.attr.subsurfAsset, "leather.subsurf")
                .addAttribute(R.attr.subsurfTechnique, "btf")
                .addAttribute(R.attr.subsurfBackend, "gl")
                .addAttribute(R.attr.subsurfGestures, "false")
                .build()
        Robolectric.buildActivity(Activity::class.java).setup().use { controller ->
            val view = SubsurfView(controller.get(), attributes)
            assertEquals(Technique.BTF, view.technique)
            assertEquals(Backend.GL, view.backend)
            assertFalse(view.hasGestures)
            controller.get().setContentView(view as View)
            assertNotNull("opened when attached", view.material)
        }
    }
}
