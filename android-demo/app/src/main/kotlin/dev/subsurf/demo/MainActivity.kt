package dev.subsurf.demo

import android.app.Activity
import android.content.Intent
import android.os.Bundle
import android.view.View
import android.view.ViewGroup.LayoutParams.MATCH_PARENT
import android.view.ViewGroup.LayoutParams.WRAP_CONTENT
import android.widget.AdapterView
import android.widget.ArrayAdapter
import android.widget.Button
import android.widget.FrameLayout
import android.widget.LinearLayout
import android.widget.ScrollView
import android.widget.Spinner
import android.widget.Switch
import android.widget.TextView
import dev.subsurf.Backend
import dev.subsurf.LoadReport
import dev.subsurf.Shape
import dev.subsurf.SubsurfMaterial
import dev.subsurf.SubsurfMesh
import dev.subsurf.SubsurfView
import dev.subsurf.Technique
import dev.subsurf.open
import java.io.IOException

/** The demo: a material on a mesh, what its load took, and how long frames take. */
class MainActivity : Activity() {
    private lateinit var view: SubsurfView
    private lateinit var text: TextView
    private val reports = Reports()
    private var material: SubsurfMaterial? = null

    override fun onCreate(savedInstanceState: Bundle?) {
        super.onCreate(savedInstanceState)
        view = SubsurfView(this)
        view.id = R.id.view
        view.listener = listener
        text = TextView(this)
        val root = FrameLayout(this)
        root.fitsSystemWindows = true
        root.addView(view, MATCH_PARENT, MATCH_PARENT)
        root.addView(controls(), MATCH_PARENT, WRAP_CONTENT)
        setContentView(root)
    }

    override fun onDestroy() {
        // The view leaves its window after this: it has to let go of the material before that is closed.
        super.onDestroy()
        view.material = null
        material?.close()
    }

    private fun controls(): View {
        val names = assets.list("").orEmpty().filter { it.endsWith(".subsurf") }
        val column = LinearLayout(this)
        column.orientation = LinearLayout.VERTICAL
        column.addView(choice(R.id.material, R.string.material, names) { show(names[it]) })
        column.addView(
            choice(R.id.mesh, R.string.mesh, Shape.entries.map { it.name.lowercase() }, Shape.KNOT.ordinal) {
                view.mesh = SubsurfMesh.of(Shape.entries[it])
            },
        )
        column.addView(
            choice(R.id.technique, R.string.technique, Technique.entries.map { it.name.lowercase() }) {
                view.technique = Technique.entries[it]
            },
        )
        column.addView(
            choice(R.id.backend, R.string.backend, Backend.entries.map { it.name.lowercase() }) {
                view.backend = Backend.entries[it]
            },
        )
        val continuous = Switch(this)
        continuous.setText(R.string.measure)
        continuous.setOnCheckedChangeListener { _, isChecked -> view.isContinuous = isChecked }
        column.addView(continuous)
        val share = Button(this)
        share.id = R.id.share
        share.setText(R.string.share)
        share.setOnClickListener { share() }
        column.addView(share)
        text.setText(if (names.isEmpty()) R.string.no_materials else R.string.help)
        column.addView(text)
        return ScrollView(this).apply { addView(column) }
    }

    private fun choice(id: Int, title: Int, names: List<String>, first: Int = 0, choose: (Int) -> Unit): View {
        val spinner = Spinner(this)
        spinner.id = id
        spinner.prompt = getString(title)
        spinner.contentDescription = getString(title)
        spinner.adapter = ArrayAdapter(this, android.R.layout.simple_spinner_dropdown_item, names)
        spinner.setSelection(first)
        spinner.onItemSelectedListener =
            object : AdapterView.OnItemSelectedListener {
                override fun onItemSelected(parent: AdapterView<*>?, selected: View?, position: Int, id: Long) =
                    choose(position)

                override fun onNothingSelected(parent: AdapterView<*>?) = Unit
            }
        return spinner
    }

    private fun show(name: String) {
        val before = material
        try {
            material = SubsurfMaterial.open(assets, name)
        } catch (e: IOException) {
            text.text = e.message
            return
        }
        reports.name = name
        view.material = material
        before?.close()
    }

    private fun share() {
        val send = Intent(Intent.ACTION_SEND).setType("text/csv").putExtra(Intent.EXTRA_TEXT, reports.csv())
        startActivity(Intent.createChooser(send, getString(R.string.share)))
    }

    private val listener =
        object : SubsurfView.Listener {
            override fun onLoaded(material: SubsurfMaterial, report: LoadReport) {
                reports.loaded(report)
                text.text = reports.text()
            }

            override fun onFrame(nanos: Long) {
                if (reports.frame(nanos)) text.text = reports.text()
            }

            override fun onError(error: Exception) {
                text.text = error.message
            }
        }
}
