package dev.subsurf.android

import android.content.Intent
import android.widget.Button
import android.widget.Spinner
import dev.subsurf.Shape
import dev.subsurf.SubsurfView
import dev.subsurf.Technique
import dev.subsurf.demo.MainActivity
import dev.subsurf.demo.R
import org.junit.Assert.assertEquals
import org.junit.Assert.assertNotNull
import org.junit.Assert.assertTrue
import org.junit.Test
import org.junit.experimental.categories.Category
import org.junit.runner.RunWith
import org.robolectric.Robolectric
import org.robolectric.RobolectricTestRunner
import org.robolectric.Shadows.shadowOf
import org.robolectric.annotation.Config

/** The demo, with the materials that scripts encode as its assets. */
@RunWith(RobolectricTestRunner::class)
@Category(OnAndroid::class)
@Config(sdk = [35])
class DemoTest {
    @Test
    fun choicesReachTheViewAndReportsAreShared() {
        Robolectric.buildActivity(MainActivity::class.java).setup().use { controller ->
            val activity = controller.get()
            fun choice(id: Int) = activity.requireViewById<Spinner>(id)
            val view = activity.requireViewById<SubsurfView>(R.id.view)
            assertTrue("assets", choice(R.id.material).adapter.count > 3)
            assertNotNull(view.material)
            val first = view.material
            choice(R.id.material).setSelection(1)
            choice(R.id.technique).setSelection(Technique.SPLAT.ordinal)
            shadowOf(activity.mainLooper).idle()
            assertTrue("another material", view.material !== first)
            assertEquals(Technique.SPLAT, view.technique)
            assertEquals(Shape.KNOT.ordinal, choice(R.id.mesh).selectedItemPosition)
            activity.requireViewById<Button>(R.id.share).performClick()
            val send = shadowOf(activity).nextStartedActivity.getParcelableExtra(Intent.EXTRA_INTENT, Intent::class.java)!!
            assertTrue(send.getStringExtra(Intent.EXTRA_TEXT)!!.startsWith("name,api,"))
        }
    }

    @Test
    fun rotationAndBackgroundDoNotHarm() {
        Robolectric.buildActivity(MainActivity::class.java).setup().use { controller ->
            controller.recreate()
            controller.pause().stop().start().resume()
            assertNotNull(controller.get().requireViewById<SubsurfView>(R.id.view).material)
        }
    }
}
