import './style.css'
document.title = 'Exitance'
