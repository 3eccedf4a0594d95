"""The page of an experiment as a template: what stands round the values."""

from __future__ import annotations

TEMPLATE = """\
{% macro table(heading, rows) %}
<table><thead><tr>{% for cell in heading %}<th>{{ cell }}</th>{% endfor %}</tr></thead><tbody>
{% for row in rows %}
<tr>{% for cell in row %}<td>{{ cell }}</td>{% endfor %}</tr>
{% endfor %}
</tbody></table>
{% endmacro %}
<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; \
style-src 'unsafe-inline'; img-src data:">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Test motions of {{ robot }}</title>
<style>
:root { color-scheme: light dark; --line: #8885; --faint: #8882; --warn: #b45309; }
body { font: 14px/1.45 system-ui, sans-serif; max-width: 62rem; margin: 1.5rem auto; \
padding: 0 1rem }
h1 { font-size: 1.5rem; margin: 0 0 .3rem } h2 { font-size: 1.15rem; margin: 1.6rem 0 .4rem }
h3 { font-size: 1rem; margin: 1rem 0 .3rem }
table { border-collapse: collapse; width: 100%; font-size: .92em; \
font-variant-numeric: tabular-nums }
th, td { text-align: left; padding: .25rem .45rem; border-bottom: 1px solid var(--line); \
vertical-align: top }
th { font-weight: 600; border-bottom-width: 2px }
.wide { overflow-x: auto } .wide td:first-child, .wide code { white-space: nowrap }
.box { display: inline-block; width: .95em; height: .95em; border: 1.5px solid currentColor; \
border-radius: 2px; vertical-align: -.12em }
.safety { border: 2px solid var(--warn); border-radius: 6px; padding: .5rem .9rem; margin: 1rem 0 }
.safety h2 { margin-top: 0; color: var(--warn) }
.stop td { border-top: 2.5px solid var(--warn) }
.jog { color: var(--warn); font-weight: 600 }
code { font: .93em ui-monospace, monospace; background: var(--faint); padding: 0 .25em; \
border-radius: 3px; overflow-wrap: anywhere }
ul.tick { list-style: none; padding-left: 0 } ul.tick li { margin: .25rem 0 .25rem 1.6em; \
text-indent: -1.6em } ul.tick .box { margin-right: .65em }
img { max-width: 100%; background: white }
.fill { border-bottom: 1px solid currentColor; display: inline-block; min-width: 11em }
@media print {
  @page { size: A4; margin: 14mm }
  :root { color-scheme: light }
  body { font-size: 10.5px; margin: 0; max-width: none; padding: 0 }
  tr, .safety, img, li { break-inside: avoid } h2, h3 { break-after: avoid }
  thead { display: table-header-group } .wide { overflow: visible }
}
</style>
</head>
<body>
<h1>Test motions of {{ robot }}</h1>
<p>{{ runs | length }} runs, {{ corners }} corners; {{ motion }} min of motion (emulated), \
{{ minutes }} min at the robot; {{ starts }} {{ "start" if starts == 1 else "starts" }}. \
Logged every {{ period }} ms.{% if cell %} Cell: {{ cell }}.{% endif %} Seed {{ seed }}.</p>
{% if notes %}
<ul>{% for note in notes %}<li>{{ note }}</li>{% endfor %}</ul>
{% endif %}
<p>Robot no. <span class="fill"></span> Date <span class="fill"></span> \
Name <span class="fill"></span></p>

<div class="safety">
<h2>Safety</h2>
<ul class="tick">
<li><span class="box"></span>Whoever starts the robot has read this page, and the rules of the \
cell hold: fence closed, nobody inside, an emergency stop within reach.</li>
<li><span class="box"></span>Tool {{ tool }} is mounted as the program declares it; its load is \
set on the controller; nothing else is mounted.</li>
<li><span class="box"></span>First pass: reduced speed, in the mode that lets you stop at any \
time, and watch each run. Second pass: speed override 100 %, which overwrites the logs of the \
first. The TCP then goes up to {{ fastest }} mm/s.</li>
<li><span class="box"></span>Runs that begin <span class="jog">by hand</span>: jog to the joint \
values in the table. The first move of the run goes there straight from where the robot stands, \
and nothing is known of that way.</li>
</ul>
</div>

<h2>At the controller</h2>
<p>The program: {% for file in files %}<code>program/{{ file }}</code> {% endfor %}</p>
<ul class="tick">
{% for step in steps %}
<li><span class="box"></span>{{ step }}</li>
{% endfor %}
<li><span class="box"></span>Put the logs beside their records in this folder: \
<code>NN_NAME.csv</code> beside <code>NN_NAME.json</code>. Logs of another form (EGM, RSI, RTDE, \
trace) do as well, under that name.</li>
</ul>

<h2>Runs</h2>
<p>In this order; what tells most comes first, so stop when time is up.</p>
<div class="wide">
<table><thead><tr><th></th><th>run and its log</th><th>what for</th><th>begins</th>\
<th>TCP, mm/s</th><th>corners</th><th>turns, °</th><th>zones, mm</th><th>motion, s</th>\
<th>over at, min</th></tr></thead><tbody>
{% for run in runs %}
<tr{% if run.by_hand %} class="stop"{% endif %}><td><span class="box"></span> {{ run.number }}</td>\
<td><code>{{ run.stem }}.csv</code></td><td>{{ run.for }}</td>\
<td>{% if run.by_hand %}<span class="jog">by hand</span>{% else %}proven{% endif %}</td>\
<td>{{ run.speed }}</td><td>{{ run.corners }}</td><td>{{ run.turns }}</td><td>{{ run.zones }}</td>\
<td>{{ run.duration }}</td><td>{{ run.clock }}</td></tr>
{% endfor %}
</tbody></table>
</div>
<p>Begins <em>proven</em>: the straight way in joint space from the end of the run before is \
proven to keep clear, and the program drives it. <em>By hand</em>: it is not; the program ends \
before the run. <em>Over at</em>: if a run takes {{ overhead }} s beside its motion.</p>

<h2>Where runs begin</h2>
<p>Joint values, degrees.</p>
<div class="wide">
<table><thead><tr><th>run</th><th>posture</th>{% for axis in axes %}<th>{{ axis }}</th>\
{% endfor %}</tr></thead><tbody>
{% for run in runs %}
<tr{% if run.by_hand %} class="stop"{% endif %}><td>{{ run.number }}{% if run.by_hand %} \
<span class="jog">by hand</span>{% endif %}</td><td>{{ run.posture }}</td>\
{% for value in run.start %}<td>{{ value }}</td>{% endfor %}</tr>
{% endfor %}
</tbody></table>
</div>

<h2>Back at the desk</h2>
<ul class="tick">
<li><span class="box"></span><code>flyby compare NN_NAME.json</code> holds a log against the \
emulation.</li>
<li><span class="box"></span><code>flyby identify FOLDER --robot {{ robot }}{{ fits }}</code> fits \
the motion model to all of them.</li>
</ul>
{% if topics %}

<h2>What the runs are for</h2>
<p><em>If instead</em>: what may be so instead of what is emulated; how much longer the run takes \
then, and how far from the emulated path it runs. <code>flyby compare NN_NAME.json</code> says \
which of them the log is nearest to.</p>
{% for topic in topics %}
<h3>{{ topic.name }}</h3>
<p>{{ topic.question }} {{ topic.decision }}</p>
{{ table(("run", "motion, s", "figures that it shows", "if instead"), topic.rows) }}
{% if topic.fits %}
<p><code>flyby identify FOLDER --robot {{ robot }}{{ topic.fits }}</code></p>
{% endif %}
{% endfor %}
{% endif %}
{% if picture %}

<h2>The runs in the cell</h2>
<p><img alt="The runs in the cell, in their planes, and what they tell" \
src="data:image/png;base64,{{ picture }}"></p>
{% endif %}

<h2>Postures</h2>
{{ table(("",) + axes, postures) }}

<h2>What the logs would tell</h2>
<p>Standard deviations of the figures of the motion model, before and after.</p>
{{ table(("figure", "looked at", "before", "after"), precision) }}
{% if skipped %}

<h2>Not possible</h2>
{{ table(("what", "why"), skipped) }}
{% endif %}
{% if unused %}

<h2>Possible, if there is more time</h2>
{{ table(("what", "why"), unused) }}
{% if unused_more %}<p>and {{ unused_more }} more.</p>{% endif %}
{% endif %}
</body>
</html>
"""
